// What carries the nodes of a level: its glTF animations, and the scripts that PLIANT_motion names.
#pragma once

#include <filesystem>
#include <optional>

#include "content/level/level.h"
#include "content/level/script.h"

namespace pliant {

// Per node of the level. Frames are those at time 0: a motion begins where it says, not where the node stands in the
// file.
struct LevelMotions {
  std::vector<std::optional<PrescribedMotion>> motion;  // of the node itself
  std::vector<bool> moves;                              // it or a node above it has one
  std::vector<LocalTransform> local;
  std::vector<dmat4> world;        // node to world
  std::vector<std::string> notes;  // of what is left out
};

// Errors, each with the node: scripts that cannot be read, animations that are not there, a script that turns a surface
// under uneven scales, soft and rigid bodies that would be carried. An animation that would change the scale of
// something that can be touched, or turn it under uneven scales, loses that part, with a note.
Result<LevelMotions> make_motions(const Level& level, const std::filesystem::path& folder, ScriptLibrary& scripts);
// The same where nothing moves.
LevelMotions unmoved(const Level& level);

}  // namespace pliant
