// Rejects files that Assimp would silently repair: faces with missing vertices, inconsistent counts, truncated files.
// Assimp clamps, drops or invents data in these cases.
#pragma once

#include <string>

#include "content/files/file_io.h"

namespace pliant {

// The input of the importer.
struct MeshFile {
  Bytes bytes;
  std::string format;      // "ply", as in a file's extension
  bool in_memory = false;  // false: may refer to other files, and is read from its own folder
};

// Checks a .obj, .off, .ply or .stl file and normalises it to a form that Assimp reads completely. Other formats are
// unchanged.
Result<MeshFile> check_mesh_file(Bytes bytes, const std::string& format);

// One check per format.
Status check_obj(Bytes& bytes);  // replaces comments after numbers by blanks
Result<Bytes> off_as_ply(
    const Bytes& bytes);  // Assimp's OFF reader supports neither comments nor faces with ten corners
Status check_ply(const Bytes& bytes);
Status check_stl(Bytes& bytes);  // removes bytes after the last triangle

}  // namespace pliant
