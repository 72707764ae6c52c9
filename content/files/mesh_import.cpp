#include "content/files/mesh_import.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "content/files/image.h"
#include "content/files/mesh_reader.h"
#include "content/gltf/form/gltf_draco.h"

namespace pliant {

namespace fs = std::filesystem;

namespace {

Result<Level> read_here(const Bytes& bytes, const std::string& format, const fs::path& path) {
  std::vector<std::string> textures;
  Result<Level> level = read_mesh_file(bytes, format, path, textures);
  if (level) add_textures(textures, path.empty() ? "/nonexistent" : path.parent_path(), *level);
  return level;
}

}  // namespace

// Loads the pictures that materials name; `names` per material, "" for none.
void add_textures(const std::vector<std::string>& names, const fs::path& folder, Level& level) {
  for (std::size_t m = 0; m < names.size() && m < level.materials.size(); ++m) {
    const std::string& name = names[m];
    if (name.empty()) continue;
    const Result<fs::path> path = confined_path(folder, name);
    Result<Image> image = path ? load_image(*path) : Result<Image>(path.error());
    if (!image) {
      level.notes.push_back("the texture " + name + " is left out: " + image.error().sentence());
      continue;
    }
    image->name = fs::path(name).filename().string();
    level.materials[m].base_color_texture = static_cast<std::int32_t>(level.images.size());
    level.images.push_back(std::move(*image));
  }
}

Result<Level> import_draco(std::span<const std::uint8_t> bytes, const std::string& name) {
  Result<DracoMesh> mesh = decode_draco_file(bytes);
  if (!mesh) return mesh.error();
  Primitive primitive;
  primitive.index = std::move(mesh->index);
  for (const DracoAttribute& attribute : mesh->attributes) {
    const std::string& semantic = attribute.name;
    const auto at = [&](std::size_t v, std::size_t c) { return attribute.values[v * attribute.width + c]; };
    for (std::size_t v = 0; v < mesh->vertices; ++v)
      for (std::size_t c = 0; c < attribute.width; ++c)
        if (!std::isfinite(at(v, c)))
          return Error{"Draco data", "has a number in " + semantic + " that is not finite", "export it again"};
    if (semantic == "POSITION" && attribute.width != 3)
      return Error{"Draco data", "has positions that are not in space", "export it again"};
    for (std::size_t v = 0; v < mesh->vertices; ++v) {
      if (semantic == "POSITION") primitive.position.emplace_back(at(v, 0), at(v, 1), at(v, 2));
      if (semantic == "NORMAL" && attribute.width == 3) primitive.normal.emplace_back(at(v, 0), at(v, 1), at(v, 2));
      if (semantic == "TEXCOORD_0" && attribute.width == 2) primitive.uv.emplace_back(at(v, 0), 1.0f - at(v, 1));
    }
  }
  if (primitive.position.empty() || primitive.index.empty())
    return Error{"Draco data", "has no triangles to touch", "export a mesh with faces"};
  for (const vec3 normal : primitive.normal)
    if (std::abs(length(normal) - 1.0f) > 0.006f) {
      primitive.normal.clear();  // recomputed at spawn
      break;
    }
  Level level;
  level.meshes.push_back({name, {std::move(primitive)}});
  LevelNode node;
  node.name = name;
  node.mesh = 0;
  level.nodes.push_back(std::move(node));
  return level;
}

Result<Level> import_mesh_here(const Bytes& bytes, const std::string& extension) {
  const std::string format = extension.empty() ? "" : extension.substr(1);
  return is_read_here(format) ? read_here(bytes, format, {}) : import_by_assimp(bytes, extension);
}

Result<Level> import_mesh(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  Result<Bytes> bytes = read_file(path, limits::kImport);
  if (!bytes) return bytes.error();
  try {
    if (extension == ".drc") return import_draco(*bytes, path.stem().string());
    const std::string format = extension.empty() ? "" : extension.substr(1);
    if (is_read_here(format)) return read_here(*bytes, format, path);
    return import_by_assimp(path, *bytes, extension);
  } catch (const std::exception& e) {
    return Error{"", std::string("cannot be read: ") + e.what(), "export it again, or as glTF"};
  }
}

}  // namespace pliant
