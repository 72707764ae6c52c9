// Keys that an animation may vary: targets of KHR_animation_pointer. Of PLIANT_deformable, and `rest` of PLIANT_joint.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"

namespace pliant {

struct VaryingKey {
  const char* key;
  Range range;
  std::vector<double DeformableParameters::*> members;  // none: of PLIANT_joint
  bool of_joint() const { return members.empty(); }
};
const std::vector<VaryingKey>& varying_keys();
// nullptr: none.
const VaryingKey* find_varying_key(const std::string& key);

// Whether the node has the extension of a key.
inline bool has_extension(const LevelNode& node, const std::string& key) {
  const VaryingKey* const its = find_varying_key(key);
  return its && its->of_joint() ? node.joint.has_value() : node.deformable.has_value();
}
// False: a key of a node that has its extension no more.
inline bool has_target(const Level& level, const LevelChannel& channel) {
  return channel.property != NodeProperty::kKey ||
         has_extension(level.nodes[static_cast<std::size_t>(channel.node)], channel.key);
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
