// In place of assimp_import.cpp where Assimp is not built: in a browser.
#include "content/files/mesh_import.h"

namespace pliant {

Result<Level> import_by_assimp(const Bytes&, const std::string& extension) {
  return Error{"", "cannot be read: this build of Pliant has no reader of " + extension,
               "convert it to glTF, .obj, .off, .ply or .stl"};
}

Result<Level> import_by_assimp(const std::filesystem::path&, const Bytes& bytes, const std::string& extension) {
  return import_by_assimp(bytes, extension);
}

}  // namespace pliant
