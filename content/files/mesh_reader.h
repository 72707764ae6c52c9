// OBJ, OFF, PLY and STL, read in one pass that checks what it reads: a face with a missing vertex, an inconsistent
// count and a truncated file are errors, never repaired. Nodes, triangles, normals and texture coordinates are those
// that Assimp reads, with these differences. Vertices stand in the order of their first use by a face; those that an
// OBJ lists twice stay two. In an OBJ the faces before the first `usemtl` keep the default material, and an object that
// is named again goes on. Faces of over four corners are split by cutting ears.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "content/files/file_io.h"
#include "content/level/level.h"

namespace pliant {

struct FaceCorner {
  std::uint32_t position = 0;
  std::int32_t uv = -1, normal = -1;  // -1: none
  bool operator==(const FaceCorner&) const = default;
};
// The faces of one material of one object.
struct FaceList {
  std::uint32_t material = 0;
  std::vector<FaceCorner> corners;   // face by face
  std::vector<std::uint32_t> sizes;  // corners of each face, 3 or more
};
struct NamedFaces {
  std::string name;  // of its node; empty: numbered
  std::vector<FaceList> lists;
};
// What a file says.
struct MeshContent {
  std::vector<vec3> position, normal;
  std::vector<vec2> uv;             // as in the file: v points up
  std::optional<std::string> root;  // name of the node above the objects; without one there is one object
  std::vector<NamedFaces> objects;
  std::vector<Material> materials;    // one at least
  std::vector<std::string> textures;  // per material: name of its picture, or ""
};

// Opens a file that another one names, beside it; nothing: it is not there, or may not be read.
using OpenBeside = std::function<std::optional<Bytes>(const std::string& name)>;

Result<MeshContent> read_obj(const Bytes& bytes, const std::string& file_name, const OpenBeside& open);
Result<MeshContent> read_off(const Bytes& bytes);
Result<MeshContent> read_ply(const Bytes& bytes);
Result<MeshContent> read_stl(const Bytes& bytes);

// Whether `format` ("ply", as in a file's extension) is read here.
bool is_read_here(const std::string& format);
// Reads a file of such a format. `textures` receives the names of pictures, per material.
Result<Level> read_mesh_file(const Bytes& bytes, const std::string& format, const std::filesystem::path& path,
                             std::vector<std::string>& textures);

// Splits a polygon of at least four corners into triangles, as indices of its corners; `at` are their places. A
// quadrangle is split at its reflex corner, if it has one; larger ones by cutting ears.
void triangulate(const std::vector<vec3>& at, std::vector<uvec3>& triangles);

}  // namespace pliant
