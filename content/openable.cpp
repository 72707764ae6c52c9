#include "content/openable.h"

#include <algorithm>
#include <cctype>

#include "content/tets/tet_file.h"

namespace pliant {

std::vector<std::string> level_endings() {
  return {".glb", ".gltf"};
}

std::vector<std::string> mesh_endings() {
  return {".obj", ".stl", ".ply", ".off", ".fbx", ".dae", ".drc", ".3mf",
          ".3ds", ".x3d", ".wrl", ".amf", ".lwo", ".ac",  ".dxf", ".blend"};
}

std::vector<std::string> openable_endings() {
  std::vector<std::string> all = level_endings();
  for (const std::vector<std::string>& more : {mesh_endings(), tet_endings()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

bool has_ending(const std::filesystem::path& file, const std::vector<std::string>& endings) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::find(endings.begin(), endings.end(), ending) != endings.end();
}

}  // namespace pliant
