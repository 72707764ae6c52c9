// Where what ships lies, and which file a LEVEL argument means.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

// PLIANT_CONTENT from the environment, else share/pliant/content beside an installed command, else the source tree's.
std::filesystem::path content_folder();

// The levels that ship, by name.
std::vector<std::filesystem::path> shipped_levels();

// A file that exists, or the name of a shipped level; empty means the demo level `three_probes`.
Result<std::filesystem::path> find_level(const std::string& argument);

}  // namespace pliant
