// Locations of the shipped files, and the file that a LEVEL argument refers to.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// share/pliant beside the command's bin/, for an installed command (which may have been moved) and for a build tree.
std::filesystem::path data_folder();

// PLIANT_CONTENT from the environment, else the data folder's content/.
std::filesystem::path content_folder();

// The levels that ship, by name.
std::vector<std::filesystem::path> shipped_levels();

// A file that exists, or the name of a shipped level; empty means the demo level `three_probes`.
Result<std::filesystem::path> find_level(const std::string& argument);

// Its world, not prepared.
Result<World> world_of_level(const std::string& argument);

}  // namespace pliant
