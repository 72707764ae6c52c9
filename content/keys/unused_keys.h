// Settings that are written but read by nobody in the scene that they stand in: a key of another law, of another
// driver, of a device that moves nothing.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"

namespace pliant {

struct UnusedKey {
  std::int32_t node = -1;  // Level node; -1: of the scene
  std::string pointer;     // "PLIANT_haptic_device/scale"; the key as in the table, relaxation.time
  std::string what;        // why it has no effect; what to do
};

// Keys whose value is other than the default, and devices as a whole; in the order of the nodes, the scene's last.
// Only nodes in the scene.
std::vector<UnusedKey> find_unused_keys(const Level& level);

// The same as notes: each key once, with how many other nodes have it too.
std::vector<std::string> unused_key_notes(const Level& level);

}  // namespace pliant
