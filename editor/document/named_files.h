// The files that a level names beside itself: scripts, a panorama, tetrahedra.
#pragma once

#include <string>
#include <vector>

#include "editor/document/state.h"

namespace pliant {

// As the level names them, each once.
std::vector<std::string> named_files(const State& state);

// External files of the level's own glTF: pictures, and buffers with its meshes, as it names them.
struct OwnFiles {
  std::vector<std::string> pictures, buffers;
};
OwnFiles own_files(const State& state);

// Those that lie in `from` and are not in `to` are copied there, so that a level that is saved elsewhere still finds
// them. The error names the first that could not be. The names of what was copied.
Result<std::vector<std::string>> bring_named_files(const State& state, const std::filesystem::path& from,
                                                   const std::filesystem::path& to);

}  // namespace pliant
