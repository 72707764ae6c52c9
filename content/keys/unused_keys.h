// Finds settings without effect in their scene: a key of another law or driver, or of a device that moves nothing.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"

namespace pliant {

struct UnusedKey {
  std::int32_t node = -1;  // Level node; -1: the scene
  std::string pointer;     // "PLIANT_haptic_device/scale"; the key as in the table, relaxation.time
  std::string what, cure;  // why it has no effect, and what to do
};

// Keys that differ from their default, and whole devices, in the order of nodes, then the scene. Only nodes in the
// scene.
std::vector<UnusedKey> find_unused_keys(const Level& level);

// The same as notes: each key once, with the number of other nodes that have it.
std::vector<Note> unused_key_notes(const Level& level);

}  // namespace pliant
