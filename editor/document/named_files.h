// The files beside a level that it refers to: scripts, a panorama, tetrahedra.
#pragma once

#include <string>
#include <vector>

#include "editor/document/state.h"

namespace pliant {

// Names as in the level, each once.
std::vector<std::string> named_files(const State& state);

// External files of the level's own glTF: pictures and mesh buffers, with their names there.
struct OwnFiles {
  std::vector<std::string> pictures, buffers;
};
OwnFiles own_files(const State& state);

// Copies the files that are in `from` and not in `to`, so that a level saved elsewhere finds them. The error names the
// first failure. Returns the copied names.
Result<std::vector<std::string>> bring_named_files(const State& state, const std::filesystem::path& from,
                                                   const std::filesystem::path& to);

}  // namespace pliant
