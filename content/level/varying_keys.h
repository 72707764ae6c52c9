// Keys of PLIANT_deformable that an animation may vary: targets of KHR_animation_pointer.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"

namespace pliant {

struct VaryingKey {
  const char* key;
  Range range;
  std::vector<double DeformableParameters::*> members;
};
const std::vector<VaryingKey>& varying_keys();
// nullptr: none.
const VaryingKey* find_varying_key(const std::string& key);

// False: a key of a node that has no PLIANT_deformable any more.
inline bool has_target(const Level& level, const LevelChannel& channel) {
  return channel.property != NodeProperty::kKey || level.nodes[static_cast<std::size_t>(channel.node)].deformable;
}

// The target of "/nodes/3/extensions/PLIANT_deformable/relaxation/time": node 3, `relaxation.time`. No node: another
// pointer.
struct KeyPointer {
  std::int64_t node = -1;
  std::string key;
};
KeyPointer key_pointer(const std::string& pointer);
std::string pointer_of_key(std::int64_t node, const std::string& key);

}  // namespace pliant
