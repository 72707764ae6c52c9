// The endings of files that are opened, listed once: for the file browser, native dialogs, dropped files and messages.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pliant {

std::vector<std::string> level_endings();  // in lower case, with their dot
std::vector<std::string> mesh_endings();   // that Assimp and Draco read
// Levels, meshes and tetrahedra (content/tets/tet_file.h): what `pliant edit`, `run` and `inspect` open.
std::vector<std::string> openable_endings();
bool has_ending(const std::filesystem::path& file, const std::vector<std::string>& endings);  // in either letter case

}  // namespace pliant
