// Loads other mesh formats: .obj, .off, .ply and .stl are read here (mesh_reader.h), the others (.fbx, .dae, ...) by
// Assimp, and bare .drc files by Draco. The Levels have no source document, one node per mesh instance, and core
// materials. Assimp runs in a child process.
#pragma once

#include <filesystem>
#include <span>

#include "content/files/file_io.h"
#include "content/level/level.h"

namespace pliant {

// Input is untrusted: bounded in size, checked for finite positions and valid indices. Errors are one sentence.
Result<Level> import_mesh(const std::filesystem::path& path);
// The same from memory, with `extension` ".ply", ".obj", ... It runs in this process, so that a fuzzer sees a crash.
// Other files named by the input are not opened.
Result<Level> import_mesh_here(const Bytes& bytes, const std::string& extension);
Result<Level> import_draco(std::span<const std::uint8_t> bytes, const std::string& name);

// By Assimp, whatever the format: a second reader for tests, in this process ...
Result<Level> import_by_assimp(const Bytes& bytes, const std::string& extension);
// ... and in a child process. A build without Assimp (no_assimp.cpp) refuses both.
Result<Level> import_by_assimp(const std::filesystem::path& path, const Bytes& bytes, const std::string& extension);

// Loads the pictures that materials name, from `folder`; `names` per material, "" for none.
void add_textures(const std::vector<std::string>& names, const std::filesystem::path& folder, Level& level);

}  // namespace pliant
