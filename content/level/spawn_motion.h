// The motions of a level's nodes: its glTF animations, and the scripts of PLIANT_motion.
#pragma once

#include <filesystem>
#include <optional>

#include "content/level/level.h"
#include "content/level/script.h"

namespace pliant {

// Per node of the level. Frames are at time 0: a motion starts at its first value, not at the node's transform in the
// file.
struct LevelMotions {
  std::vector<std::optional<PrescribedMotion>> motion;  // the node's own
  std::vector<bool> moves;                              // it or an ancestor has a motion
  std::vector<LocalTransform> local;
  std::vector<dmat4> world;        // node to world
  std::vector<std::string> notes;  // on omitted parts
};

// Errors name the node: unreadable scripts, missing animations, a script that rotates a surface under non-uniform
// scales, carried soft or rigid bodies. An animation loses, with a note, the part that would scale something touchable,
// or rotate it under non-uniform scales.
Result<LevelMotions> make_motions(const Level& level, const std::filesystem::path& folder, ScriptLibrary& scripts);
// The same without motion.
LevelMotions unmoved(const Level& level);

}  // namespace pliant
