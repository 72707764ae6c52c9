// What Assimp would read differently than it stands in the file: faces that name vertices which are not there, counts
// that do not agree, files that are cut off. It clamps, drops or invents; here such a file is refused before it.
#pragma once

#include <string>

#include "content/files/file_io.h"

namespace pliant {

// What the importer is handed of a file.
struct MeshFile {
  Bytes bytes;
  std::string format;      // "ply", as in a file's extension
  bool in_memory = false;  // false: it may name other files, and is read from where it lies
};

// A .obj, .off, .ply or .stl as a sound file of a format that Assimp reads whole; other formats as they are.
Result<MeshFile> check_mesh_file(Bytes bytes, const std::string& format);

// Of one format each.
Status check_obj(Bytes& bytes);  // comments behind numbers become blanks
Result<Bytes> off_as_ply(
    const Bytes& bytes);  // Assimp's own reader of OFF knows no comments and no face of ten corners
Status check_ply(const Bytes& bytes);
Status check_stl(Bytes& bytes);  // what stands behind the last triangle is cut off

}  // namespace pliant
