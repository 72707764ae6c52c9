// Meshes of other formats (.obj, .ply, .off, .stl, .fbx, ...) through Assimp, and bare .drc files through Draco, as
// Levels without a source document: one node a mesh instance, core materials. The libraries run in a child process.
#pragma once

#include <filesystem>
#include <span>

#include "content/files/file_io.h"
#include "content/level/level.h"

namespace pliant {

// Untrusted like everything else: bounded in size, checked for finite positions and indices, refused in one sentence.
Result<Level> import_mesh(const std::filesystem::path& path);
// The same of bytes in memory, with `extension` ".ply", ".obj", ...: in this process, for fuzzing, where a crash is to
// be seen. Files that it names are not sought.
Result<Level> import_mesh_here(const Bytes& bytes, const std::string& extension);
Result<Level> import_draco(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace pliant
