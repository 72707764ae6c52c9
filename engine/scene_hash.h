// Identity of a scene for recordings, and part of the identity of a sweep's run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "content/level/level.h"
#include "runtime/hash.h"

namespace pliant {

// Hash of everything that affects forces: meshes, their nodes, transforms and hierarchy, keys, animations, and the
// bytes of files that keys name. Excluded: error budgets, whose effect is in other keys, and device scripts, whose
// poses are in a recording. Never 0.
std::uint64_t scene_hash(const Level& level);

void add_text(Hash& hash, const std::string& text);
// Adds the bytes of the file that a key calls `name`, relative to the level's folder, and of TetGen's second file. Adds
// nothing if the file is missing.
void add_named_file(Hash& hash, const std::filesystem::path& folder, const std::string& name);

}  // namespace pliant
