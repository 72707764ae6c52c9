// Identity of a scene for recordings, and part of the identity of a sweep's run.
#pragma once

#include <cstdint>

#include "content/level/file_hash.h"
#include "content/level/level.h"

namespace pliant {

// Hash of everything that affects forces: meshes, their nodes, transforms and hierarchy, keys, animations, and the
// bytes of files that keys name. Excluded: error budgets, whose effect is in other keys, and device scripts, whose
// poses are in a recording. Never 0.
std::uint64_t scene_hash(const Level& level);

}  // namespace pliant
