// OBJ, OFF, PLY and STL against a second reader, Assimp, and against each other; faces of many corners against their
// area.
#include "content/files/mesh_reader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>

#include "content/files/mesh_import.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

using Vertex = std::array<float, 8>;      // position, normal, uv
using Triangle = std::array<Vertex, 3>;   // begins at its least vertex
using Triangles = std::vector<Triangle>;  // sorted

Triangles triangles_of(const LevelMesh& mesh) {
  Triangles all;
  for (const Primitive& p : mesh.primitives)
    for (std::size_t t = 0; t + 3 <= p.index.size(); t += 3) {
      Triangle triangle{};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t v = p.index[t + i];
        const vec3 at = p.position[v], normal = p.normal.empty() ? vec3(0) : p.normal[v];
        const vec2 uv = p.uv.empty() ? vec2(0) : p.uv[v];
        triangle[i] = {at.x, at.y, at.z, normal.x, normal.y, normal.z, uv.x, uv.y};
      }
      std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
      all.push_back(triangle);
    }
  std::sort(all.begin(), all.end());
  return all;
}

std::map<std::string, Triangles> meshes_of(const Level& level) {
  std::map<std::string, Triangles> all;
  for (const LevelMesh& mesh : level.meshes) {
    Triangles& of = all[mesh.name];
    const Triangles more = triangles_of(mesh);
    of.insert(of.end(), more.begin(), more.end());
    std::sort(of.begin(), of.end());
  }
  return all;
}

Triangles all_of(const Level& level) {
  Triangles all;
  for (const auto& [name, triangles] : meshes_of(level)) all.insert(all.end(), triangles.begin(), triangles.end());
  std::sort(all.begin(), all.end());
  return all;
}

// Equal up to the rounding of a normal's length and of decimal text.
void expect_same(const Triangles& a, const Triangles& b, const std::string& where) {
  ASSERT_EQ(a.size(), b.size()) << where;
  for (std::size_t t = 0; t < a.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 8; ++k)
        ASSERT_NEAR(a[t][i][k], b[t][i][k], 1e-6 * (1.0 + std::abs(b[t][i][k])))
            << where << ": triangle " << t << ", corner " << i << ", number " << k;
}

Bytes bytes_of(const std::string& text) {
  return Bytes(text.begin(), text.end());
}

// Faces of more than four corners are split by another rule than Assimp's.
bool has_many_corners(const std::string& file, const Bytes& bytes) {
  const OpenBeside none = [](const std::string&) { return std::optional<Bytes>(); };
  const Result<MeshContent> content = file.ends_with(".obj")   ? read_obj(bytes, file, none)
                                      : file.ends_with(".off") ? read_off(bytes)
                                      : file.ends_with(".ply") ? read_ply(bytes)
                                                               : read_stl(bytes);
  for (const NamedFaces& object : content->objects)
    for (const FaceList& faces : object.lists)
      for (const std::uint32_t size : faces.sizes)
        if (size > 4) return true;
  return false;
}

TEST(MeshReader, ReadsWhatAssimpReads) {
  int compared = 0;
  for (const fs::path& folder : {fs::path(PLIANT_CORPUS_DIR), fs::path(PLIANT_SOURCE_DIR) / "content/samples"}) {
    if (!fs::exists(folder)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension.empty() || !is_read_here(extension.substr(1)) || extension == ".off") continue;
      const Bytes bytes = read_file(entry.path()).value();
      const Result<Level> ours = import_mesh_here(bytes, extension);
      if (!ours) continue;  // refused: mesh_check_test.cpp
      const Result<Level> theirs = import_by_assimp(bytes, extension);
      if (!theirs || has_many_corners(entry.path().filename().string(), bytes)) continue;
      expect_same(all_of(*ours), all_of(*theirs), entry.path().string());
      ASSERT_EQ(ours->meshes.size(), theirs->meshes.size()) << entry.path();
      for (std::size_t m = 0; m < ours->meshes.size(); ++m)
        expect_same(triangles_of(ours->meshes[m]), triangles_of(theirs->meshes[m]), ours->meshes[m].name);
      ++compared;
    }
  }
  EXPECT_GE(compared, 5);
}

// One body of triangles and quadrangles with normals and texture coordinates, in every format.
struct Grid {
  std::vector<vec3> position, normal;
  std::vector<vec2> uv;
  std::vector<std::vector<int>> faces;
  Grid() {
    constexpr int n = 7;
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x <= n; ++x) {
        position.emplace_back(x, y, 0.25f * static_cast<float>((x * 5 + y * 3) % 4));
        normal.push_back(glm::normalize(vec3(0.125f * static_cast<float>(x - y), 0.25f, 1.0f)));
        uv.emplace_back(static_cast<float>(x) / 8.0f, static_cast<float>(y) / 8.0f);
      }
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const int a = y * (n + 1) + x;
        if ((x + y) % 3 == 0) {
          faces.push_back({a, a + 1, a + n + 2});
          faces.push_back({a, a + n + 2, a + n + 1});
        } else {
          faces.push_back({a, a + 1, a + n + 2, a + n + 1});
        }
      }
  }
};

template <class T>
void put(std::string& out, T value, bool swap) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (swap) std::reverse(raw, raw + sizeof value);
  out.append(raw, sizeof value);
}

TEST(MeshReader, TheSameBodyIsTheSameInEveryFormat) {
  const Grid grid;
  std::string obj, off = "STNOFF\n", ply, binary[2];
  const std::string counts = std::to_string(grid.position.size()) + ' ' + std::to_string(grid.faces.size());
  const auto text = [](const vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); };
  off += counts + " 0\n";
  const auto head = [&](const char* format) {
    std::string out =
        std::string("ply\nformat ") + format + " 1.0\nelement vertex " + std::to_string(grid.position.size()) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "s", "t"})
      out += std::string("property float ") + name + "\n";
    return out + "element face " + std::to_string(grid.faces.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
  };
  ply = head("ascii");
  binary[0] = head("binary_little_endian");
  binary[1] = head("binary_big_endian");
  for (std::size_t v = 0; v < grid.position.size(); ++v) {
    const std::string uv = fmt::format("{} {}", grid.uv[v].x, grid.uv[v].y);
    obj += "v " + text(grid.position[v]) + "\nvn " + text(grid.normal[v]) + "\nvt " + uv + "\n";
    const std::string row = text(grid.position[v]) + ' ' + text(grid.normal[v]) + ' ' + uv + '\n';
    off += row;
    ply += row;
    for (const bool swap : {false, true})
      for (const float number : {grid.position[v].x, grid.position[v].y, grid.position[v].z, grid.normal[v].x,
                                 grid.normal[v].y, grid.normal[v].z, grid.uv[v].x, grid.uv[v].y})
        put(binary[swap], number, swap);
  }
  for (const std::vector<int>& face : grid.faces) {
    std::string row = std::to_string(face.size());
    obj += "f";
    for (const bool swap : {false, true}) binary[swap] += static_cast<char>(face.size());
    for (const int v : face) {
      row += ' ' + std::to_string(v);
      obj += fmt::format(" {0}/{0}/{0}", v + 1);
      for (const bool swap : {false, true}) put(binary[swap], v, swap);
    }
    obj += "\n";
    off += row + "\n";
    ply += row + "\n";
  }
  const Result<Level> first = import_mesh_here(bytes_of(obj), ".obj");
  ASSERT_TRUE(first) << first.error().message();
  const Triangles expected = all_of(*first);
  ASSERT_EQ(expected.size(), 2u * 49u);
  for (const auto& [name, file, extension] : {std::tuple("off", off, ".off"),
                                              {"ply", ply, ".ply"},
                                              {"little", binary[0], ".ply"},
                                              {"big", binary[1], ".ply"}}) {
    const Result<Level> level = import_mesh_here(bytes_of(file), extension);
    ASSERT_TRUE(level) << name << ": " << level.error().message();
    expect_same(all_of(*level), expected, name);
    if (std::string(extension) == ".off") continue;  // Assimp's reader has no texture coordinates of it
    const Result<Level> theirs = import_by_assimp(bytes_of(file), extension);
    ASSERT_TRUE(theirs) << name;
    expect_same(all_of(*level), all_of(*theirs), std::string(name) + " by Assimp");
  }
  const Result<Level> theirs = import_by_assimp(bytes_of(obj), ".obj");
  ASSERT_TRUE(theirs);
  expect_same(expected, all_of(*theirs), "obj by Assimp");
}

TEST(MeshReader, MaterialsGroupsAndObjectsOfAnObjAreKept) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  const OpenBeside open = [](const std::string& name) -> std::optional<Bytes> {
    if (name != "two words.mtl") return std::nullopt;
    return bytes_of("newmtl red\nKd 1 0 0\nd 0.5\nmap_Kd -s 1 1 1 a picture.png\nnewmtl blue\nKd 0 0 1\n");
  };
  const Result<MeshContent> content = read_obj(
      bytes_of("mtllib two words.mtl\n" + v + "f 1 2 3\no one two\nusemtl red\nf 1 3 4\nusemtl blue\nf 1 2 4\n" +
               "g a  b\nf 2 3 4\nusemtl new\nf 1 2 3\no one\nf 2 3 4\no empty\n"),
      "file.obj", open);
  ASSERT_TRUE(content) << content.error().message();
  EXPECT_EQ(*content->root, "file.obj");
  std::vector<std::string> objects, materials;
  for (const NamedFaces& object : content->objects) {
    objects.push_back(object.name + ':');
    for (const FaceList& faces : object.lists)
      if (!faces.sizes.empty())
        objects.back() += fmt::format(" {}x{}", faces.sizes.size(), content->materials[faces.material].name);
  }
  EXPECT_EQ(objects, (std::vector<std::string>{"defaultobject: 1xDefaultMaterial", "one two: 1xred 1xblue",
                                               "a  b: 1xblue 1xnew", "one: 1xnew", "empty:"}));
  ASSERT_EQ(content->materials.size(), 4u);
  EXPECT_EQ(content->materials[1].base_color, vec4(1, 0, 0, 0.5f));
  EXPECT_EQ(content->materials[1].alpha, Material::Alpha::kBlend);
  EXPECT_EQ(content->materials[2].base_color, vec4(0, 0, 1, 1));
  EXPECT_EQ(content->textures, (std::vector<std::string>{"", "a picture.png", "", ""}));
}

TEST(MeshReader, EveryOtherTriangleOfAStripIsTurned) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n";
  const Result<MeshContent> content = read_ply(bytes_of(head + "9 0 1 2 3 -1 2 3 4 5\n"));
  ASSERT_TRUE(content) << content.error().message();
  const FaceList& faces = content->objects[0].lists[0];
  ASSERT_EQ(faces.sizes.size(), 4u);
  for (std::size_t t = 0; t < 4; ++t) {  // all seen from above
    const auto at = [&](std::size_t i) { return content->position[faces.corners[3 * t + i].position]; };
    EXPECT_EQ(cross(at(1) - at(0), at(2) - at(0)), vec3(0, 0, 1)) << t;
  }
}

// Polygons around a centre that all their corners see, in random planes: the triangles have the polygon's vector area,
// and none is turned.
TEST(MeshReader, EarsCoverAFaceOfAnyShape) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> radius(0.2, 1.0), turn(-1.0, 1.0);
  for (int n = 0; n < 400; ++n) {
    const dvec3 normal = glm::normalize(dvec3(turn(random), turn(random), turn(random)));
    const dvec3 u = glm::normalize(cross(normal, std::abs(normal.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
    const dvec3 v = cross(normal, u);
    std::vector<vec3> at;
    const int corners = 4 + n % 13;
    dvec3 whole(0);
    for (int i = 0; i < corners; ++i) {
      const double a = 2 * std::numbers::pi * i / corners, r = radius(random);
      at.emplace_back(r * std::cos(a) * u + r * std::sin(a) * v);
    }
    for (std::size_t i = 0; i < at.size(); ++i) whole += 0.5 * cross(dvec3(at[i]), dvec3(at[(i + 1) % at.size()]));
    std::vector<uvec3> triangles;
    triangulate(at, triangles);
    ASSERT_EQ(triangles.size(), at.size() - 2);
    dvec3 sum(0);
    for (const uvec3& t : triangles) {
      const dvec3 area = 0.5 * cross(dvec3(at[t.y] - at[t.x]), dvec3(at[t.z] - at[t.x]));
      sum += area;
      EXPECT_GT(dot(area, normal), -1e-6) << corners << " corners, face " << n;
    }
    EXPECT_LT(length(sum - whole), 1e-6) << corners << " corners, face " << n;
  }
}

}  // namespace
}  // namespace pliant::test
