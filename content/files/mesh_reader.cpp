#include "content/files/mesh_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "content/gltf/form/gltf_document.h"

namespace pliant {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostCorners = 10000;          // of a face: cutting ears takes the square of it
constexpr std::size_t kMostFileVertices = 1u << 26;  // of a file
constexpr const char* kNoName = "defaultobject";     // faces before any `o` or `g` of an OBJ

struct CornerHash {
  std::size_t operator()(const FaceCorner& c) const {
    std::uint64_t h = c.position * 0x9e3779b97f4a7c15u;
    h = (h ^ static_cast<std::uint32_t>(c.uv)) * 0xbf58476d1ce4e5b9u;
    h = (h ^ static_cast<std::uint32_t>(c.normal)) * 0x94d049bb133111ebu;
    return h ^ (h >> 31);
  }
};

// Twice the area of a triangle in the plane, positive if it is counter-clockwise.
double twice_area(const dvec2& a, const dvec2& b, const dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Whether p is inside of or on the triangle, which is counter-clockwise.
bool ear_holds(const dvec2& a, const dvec2& b, const dvec2& c, const dvec2& p) {
  return twice_area(a, b, p) >= 0.0 && twice_area(b, c, p) >= 0.0 && twice_area(c, a, p) >= 0.0;
}

// The first corner whose interior angle is over 180 degrees; 0 if there is none.
std::uint32_t reflex_corner(const std::vector<vec3>& at) {
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto way = [&](std::uint32_t k) { return glm::normalize(at[(i + k) % 4] - at[i]); };
    const vec3 left = way(3), diagonal = way(2), right = way(1);
    const float angle = std::acos(dot(left, diagonal)) + std::acos(dot(right, diagonal));
    if (angle > std::numbers::pi_v<float>) return i;
  }
  return 0;
}

// The places in the plane that the polygon lies in best, counter-clockwise.
std::vector<dvec2> flattened(const std::vector<vec3>& at) {
  dvec3 normal(0);  // Newell
  for (std::size_t i = 0; i < at.size(); ++i) {
    const dvec3 a(at[i]), b(at[(i + 1) % at.size()]);
    normal += dvec3((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
  }
  const dvec3 size = glm::abs(normal);
  const int up = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  const int u = (up + 1) % 3, v = (up + 2) % 3;
  std::vector<dvec2> flat;
  for (const vec3& p : at) flat.emplace_back(normal[up] < 0.0 ? -p[u] : p[u], p[v]);
  return flat;
}

void cut_ears(const std::vector<vec3>& at, std::vector<uvec3>& triangles) {
  const std::vector<dvec2> p = flattened(at);
  std::vector<std::uint32_t> left(at.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    std::size_t ear = n;
    for (std::size_t i = 0; i < n && ear == n; ++i) {
      const dvec2 &a = p[left[(i + n - 1) % n]], &b = p[left[i]], &c = p[left[(i + 1) % n]];
      if (!(twice_area(a, b, c) > 0.0)) continue;
      bool free = true;
      for (std::size_t k = 0; k < n && free; ++k) {
        const dvec2& q = p[left[k]];
        if (q != a && q != b && q != c) free = !ear_holds(a, b, c, q);
      }
      if (free) ear = i;
    }
    if (ear == n) ear = 0;  // it crosses itself, or has no area
    triangles.emplace_back(left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.emplace_back(left[0], left[1], left[2]);
}

Result<Primitive> primitive_of(const MeshContent& content, const FaceList& faces) {
  Primitive out;
  out.material = static_cast<std::int32_t>(faces.material);
  const auto any = [&](auto member) {
    return std::any_of(faces.corners.begin(), faces.corners.end(),
                       [member](const FaceCorner& corner) { return corner.*member >= 0; });
  };
  const bool has_uv = any(&FaceCorner::uv), has_normals = any(&FaceCorner::normal);
  bool sound_normals = has_normals;
  std::unordered_map<FaceCorner, std::uint32_t, CornerHash> known;
  const auto vertex = [&](const FaceCorner& corner) {
    const auto [place, is_new] = known.try_emplace(corner, static_cast<std::uint32_t>(out.position.size()));
    if (!is_new) return place->second;
    out.position.push_back(content.position[corner.position]);
    if (has_uv) {
      const vec2 uv = corner.uv < 0 ? vec2(0) : content.uv[static_cast<std::size_t>(corner.uv)];
      // In glTF, v points down.
      out.uv.emplace_back(std::isfinite(uv.x) ? uv.x : 0.0f, std::isfinite(uv.y) ? 1.0f - uv.y : 0.0f);
    }
    if (has_normals) {
      const vec3 normal = corner.normal < 0 ? vec3(0) : content.normal[static_cast<std::size_t>(corner.normal)];
      const float size = length(normal);
      sound_normals &= std::isfinite(size) && size > 0.0f;
      out.normal.push_back(normal / size);
    }
    return place->second;
  };
  std::vector<vec3> at;
  std::vector<uvec3> triangles;
  std::size_t first = 0;
  for (const std::uint32_t size : faces.sizes) {
    if (size > kMostCorners)
      return Error{"", fmt::format("has a face of {} corners", size), "triangulate it, and export it again"};
    triangles.clear();
    if (size == 3) {
      triangles.emplace_back(0, 1, 2);
    } else {
      at.clear();
      for (std::size_t i = 0; i < size; ++i) at.push_back(content.position[faces.corners[first + i].position]);
      triangulate(at, triangles);
    }
    for (const uvec3& t : triangles)
      for (int i = 0; i < 3; ++i) out.index.push_back(vertex(faces.corners[first + t[i]]));
    first += size;
  }
  if (!sound_normals) out.normal.clear();  // recomputed at spawn
  return out;
}

// Names in files are arbitrary bytes; names in a Level are UTF-8.
std::string utf8_of(const std::string& bytes) {
  return Json::parse(Json(bytes).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

Status check_length(const std::string& name) {
  if (name.size() <= most(limits::kName)) return Done{};
  return error_at("", beyond("has a name of", limits::kName, static_cast<double>(name.size()), "shorten it"));
}

Result<Level> level_from(const MeshContent& content, const std::string& stem) {
  Level level;
  level.materials = content.materials;
  for (Material& material : level.materials) {
    material.name = utf8_of(material.name);
    if (const Status fine = check_length(material.name); !fine) return fine.error();
  }
  if (content.root) level.nodes.emplace_back().name = content.root->empty() ? "node_0" : utf8_of(*content.root);
  if (content.objects.size() + 1 > most(limits::kElements))
    return error_at("",
                    beyond("has", limits::kElements, static_cast<double>(content.objects.size() + 1), "simplify it"));
  std::size_t vertices = 0;
  for (const NamedFaces& object : content.objects) {
    const auto here = static_cast<std::int32_t>(level.nodes.size());
    LevelNode node;
    node.parent = content.root ? 0 : -1;
    node.name = object.name.empty() ? fmt::format("node_{}", here) : utf8_of(object.name);
    if (node.name == kNoName && !stem.empty()) node.name = stem;
    if (const Status fine = check_length(node.name); !fine) return fine.error();
    LevelMesh mesh;
    mesh.name = node.name;
    for (const FaceList& faces : object.lists) {
      if (faces.sizes.empty()) continue;
      Result<Primitive> primitive = primitive_of(content, faces);
      if (!primitive) return primitive.error();
      vertices += primitive->position.size();
      if (vertices > kMostFileVertices) return Error{"", "has more than 67 million vertices", "split it"};
      mesh.primitives.push_back(std::move(*primitive));
    }
    if (!mesh.primitives.empty()) {
      node.mesh = static_cast<std::int32_t>(level.meshes.size());
      level.meshes.push_back(std::move(mesh));
    }
    if (content.root) level.nodes.front().children.push_back(here);
    level.nodes.push_back(std::move(node));
  }
  if (level.meshes.empty()) return Error{"", "has no triangles", "a point cloud or an empty mesh cannot be touched"};
  return level;
}

// Files named by a file: within the folders that a level may reach.
std::optional<Bytes> open_beside(const fs::path& path, const std::string& name) {
  const Result<fs::path> file = confined_file(path.parent_path(), name);
  if (!file) return std::nullopt;
  Result<Bytes> bytes = read_file(*file, limits::kImport);
  if (!bytes) return std::nullopt;
  return std::move(bytes).value();
}

}  // namespace

void triangulate(const std::vector<vec3>& at, std::vector<uvec3>& triangles) {
  if (at.size() > 4) return cut_ears(at, triangles);
  const std::uint32_t s = reflex_corner(at);
  triangles.emplace_back(s, (s + 1) % 4, (s + 2) % 4);
  triangles.emplace_back(s, (s + 2) % 4, (s + 3) % 4);
}

bool is_read_here(const std::string& format) {
  return format == "obj" || format == "off" || format == "ply" || format == "stl";
}

Result<Level> read_mesh_file(const Bytes& bytes, const std::string& format, const fs::path& path,
                             std::vector<std::string>& textures) {
  const OpenBeside open = [&](const std::string& name) {
    return path.empty() ? std::nullopt : open_beside(path, name);
  };
  Result<MeshContent> content = format == "obj"   ? read_obj(bytes, path.filename().string(), open)
                                : format == "off" ? read_off(bytes)
                                : format == "ply" ? read_ply(bytes)
                                                  : read_stl(bytes);
  if (!content) return content.error();
  textures = content->textures;
  for (std::string& name : textures) name = utf8_of(name);
  return level_from(*content, utf8_of(path.stem().string()));
}

}  // namespace pliant
