// What makes two scenes the same to a recording, and a part of what makes two runs of a sweep the same.
#pragma once

#include <cstdint>

#include "content/level/file_hash.h"
#include "content/level/level.h"

namespace pliant {

// Of everything that is felt: meshes, which node has which, where nodes are and hang, keys, animations, and the bytes
// of files that keys name. Not of an error budget, which is felt by what was chosen for it, in other keys; nor of
// scripts of devices, whose poses a recording has. Never 0.
std::uint64_t scene_hash(const Level& level);

}  // namespace pliant
