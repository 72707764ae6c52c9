// Where surfaces meet so closely that they are one to a probe: nodes that lie flush against each other, an organ in
// parts, and cracks in one mesh. A foot that comes to such an edge goes on upon the other surface.
#pragma once

#include "systems/touch/touch_state.h"

namespace pliant {

// A crack narrower than this share of the mesh's mean edge does not exist (nor one a third wider). [1]
inline constexpr double kCrack = 0.02;

// The seam that a foot lies on, or null.
const Seam* seam_at(const ObjectState& object, const Foot& foot);
// Whether a foot lies on either side of a seam.
bool at_seam(const ObjectState& object, const Foot& foot);

// Fills ObjectState::seams and closed. What moves has no seams with others. Allocates.
void find_seams(const World& world, TouchState& touch);

}  // namespace pliant
