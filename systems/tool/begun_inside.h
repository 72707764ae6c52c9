// Probes and rigid tools that are placed inside a rigid body. They touch nothing until they have left it: contacts
// would push them out with a blow, and the hand with them. Probes on P1 surfaces begin in the same way.
#pragma once

#include "systems/soft/soft_state.h"

namespace pliant {

// Whether the tool number `index`, which has just been placed, is inside a rigid body by over 1 % of the smaller
// diagonal. Records the deepest case in SoftTally.
bool begins_inside(SoftState& soft, std::size_t index);
// Whether it is in one at all.
bool still_inside(const SoftState& soft, std::size_t index);
// Whether a tool in a body has no contacts.
inline bool begins_without_contact(const Body& tool, const Body& body) {
  return tool.as_tool() && tool.pose_after(0.0) && !body.as_tissue();
}

}  // namespace pliant
