// Sound and broken files of other formats: none may be read differently from its content.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "content/level_file.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

struct File {
  const char* name;
  std::string text;
  std::size_t triangles;  // of a sound file
};
struct Broken {
  const char* name;
  std::string text;
  const char* said;  // part of the error sentence
};

class MeshCheck : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  Result<Level> read(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return load_level(folder_ / name);
  }
  void expect_sound(const std::vector<File>& files) {
    for (const File& file : files) {
      const Result<Level> level = read(file.name, file.text);
      ASSERT_TRUE(level.ok()) << file.name << ": " << level.error().message();
      std::size_t triangles = 0;
      for (const LevelMesh& mesh : level->meshes)
        for (const Primitive& p : mesh.primitives) triangles += p.index.size() / 3;
      EXPECT_EQ(triangles, file.triangles) << file.name << '\n' << file.text;
    }
  }
  void expect_refused(const std::vector<Broken>& files) {
    for (const Broken& file : files) {
      const Result<Level> level = read(file.name, file.text);
      ASSERT_FALSE(level.ok()) << file.name << '\n' << file.text;
      const std::string sentence = level.error().message();
      EXPECT_EQ(sentence.rfind((folder_ / file.name).string(), 0), 0u) << sentence;
      EXPECT_NE(sentence.find(file.said), std::string::npos) << sentence << " for\n" << file.text;
    }
  }
  const fs::path folder_ = fs::temp_directory_path() / ("pliant-mesh-check-" + std::to_string(::getpid()));
};

const std::string kVertices = "0 0 0\n1 0 0\n0 1 0\n";

TEST_F(MeshCheck, OffIsReadWithCommentsEveryHeaderAndFacesOfAnyNumberOfCorners) {
  std::string ring;
  for (int i = 0; i < 12; ++i)
    ring += std::to_string(std::cos(i * 0.5236)) + " " + std::to_string(std::sin(i * 0.5236)) + " 0\n";
  expect_sound({{"a.off", "OFF\n3 1 0\n" + kVertices + "3 0 1 2\n", 1},
                {"b.off", "# by hand\nOFF # text\n3 1 0\n\n0 0 0\n1 0 0 # here\n# there\n0 1 0\n3 0 1 2 255 0 0\n", 1},
                {"c.off", "OFF 3 1 0\n" + kVertices + "3 0 1 2\n", 1},
                {"d.off", "3 1\n" + kVertices + "3 0 1 2", 1},
                {"e.off", "COFF\r\n3 1 0\r\n0 0 0 1 0 0 1\r\n1 0 0 1 0 0 1\r\n0 1 0 1 0 0 1\r\n3 0 1 2\r\n", 1},
                {"f.off", "STNOFF\n3 1 0\n0 0 0 0 0 1 .5 .5\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n3 0 1 2\n", 1},
                {"g.off", "nOFF\n3\n3 1 0\n" + kVertices + "3 0 1 2\n", 1},
                {"h.off", "OFF\n12 1 0\n" + ring + "12 0 1 2 3 4 5 6 7 8 9 10 11\n", 10}});
  const Result<Level> homogeneous = read("w.off", "4OFF\n3 1 0\n0 0 0 2\n2 0 0 2\n0 2 0 2\n3 0 1 2\n");
  ASSERT_TRUE(homogeneous.ok());
  float largest = 0.0f;
  for (const vec3 p : homogeneous->meshes[0].primitives[0].position) largest = std::max(largest, length(p));
  EXPECT_EQ(largest, 1.0f);
}

TEST_F(MeshCheck, BrokenOffIsRefused) {
  expect_refused({{"a.off", "OFF\n3 1 0\n" + kVertices + "3 0 1 7\n", "vertex 7 of 3"},
                  {"b.off", "OFF\n3 1 0\n" + kVertices + "3 0 1 -1\n", "vertex -1 of 3"},
                  {"c.off", "OFF\n3 2 0\n" + kVertices + "3 0 1 2\n", "before face 1 of 2"},
                  {"d.off", "OFF\n4 1 0\n" + kVertices + "3 0 1 2\n", "before face 0 of 1"},
                  {"e.off", "OFF\n3 1 0\n" + kVertices + "4 0 1 2\n", "too few numbers for face 0"},
                  {"f.off", "OFF\n3 1 0\n0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n", "vertex 1"},
                  {"g.off", "OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n", "finite"},
                  {"h.off", "OFF\n3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2\n", "line of its own"},
                  {"i.off", "OFF BINARY\n", "binary"},
                  {"j.off", "OFF\n", "cut off"},
                  {"k.off", "OFF\n3000000000 1 0\n", "claims"}});
}

std::string ply(const char* format, int vertices, int faces) {
  return std::string("ply\nformat ") + format + " 1.0\ncomment made by hand\nelement vertex " +
         std::to_string(vertices) + "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n";
}
template <class T>
void append(std::string& out, T value, bool big) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  if (big) std::reverse(bytes, bytes + sizeof(T));
  out.append(bytes, sizeof(T));
}
std::string body(std::initializer_list<std::int32_t> corners, bool big) {
  std::string out;
  for (const float c : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) append(out, c, big);
  int n = 0;
  for (const std::int32_t corner : corners) {
    if (n++ % 3 == 0) out += '\3';
    append(out, corner, big);
  }
  return out;
}

TEST_F(MeshCheck, PlyIsReadAsTextAndInBothByteOrders) {
  const std::string text = ply("ascii", 3, 1) + kVertices + "3 0 1 2";
  std::string lines = text;
  for (std::size_t at = 0; (at = lines.find('\n', at)) != std::string::npos; at += 2) lines.replace(at, 1, "\r\n");
  expect_sound({{"a.ply", text, 1}, {"b.ply", lines, 1}});
  for (const bool big : {false, true})
    expect_sound(
        {{"c.ply", ply(big ? "binary_big_endian" : "binary_little_endian", 3, 2) + body({0, 1, 2, 0, 2, 1}, big), 2}});
}

TEST_F(MeshCheck, BrokenPlyIsRefused) {
  expect_refused({{"a.ply", ply("ascii", 3, 1) + kVertices + "3 0 1 9\n", "vertex 9 of 3"},
                  {"b.ply", ply("ascii", 3, 1) + kVertices + "3 0 1 -1\n", "vertex -1 of 3"},
                  {"c.ply", ply("ascii", 3, 2) + kVertices + "3 0 1 2\n", "before face 1 of 2"},
                  {"d.ply", ply("ascii", 4, 1) + kVertices + "3 0 1 2\n", "before face 0 of 1"},
                  {"e.ply", ply("ascii", 3, 1) + kVertices + "3 0 1\n", "face 0"},
                  {"f.ply", ply("ascii", 3, 1) + "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n", "vertex 1"},
                  {"n.ply", ply("ascii", 3, 2) + kVertices + "0\n3 0 1 2\n", "without a corner"},
                  {"g.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "header"},
                  {"h.ply", ply("utf8", 3, 1), "format"}});
  for (const bool big : {false, true}) {
    const std::string head = ply(big ? "binary_big_endian" : "binary_little_endian", 3, 2);
    const std::string whole = head + body({0, 1, 2, 0, 2, 1}, big);
    expect_refused({{"i.ply", head + body({0, 1, 2, 0, 2, 7}, big), "vertex 7 of 3"},
                    {"j.ply", head + body({0, 1, 2, 0, 2, -1}, big), "vertex -1 of 3"},
                    {"k.ply", head + body({0, 1, 2}, big), "face 1"},
                    {"l.ply", whole.substr(0, whole.size() - 3), "face 1"},
                    {"m.ply", head + body({}, big).substr(0, 20), "vertex"}});
  }
}

TEST_F(MeshCheck, ObjIsReadWithNegativeAndForwardReferencesAndLinesThatGoOn) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_sound({{"a.obj", v + "f 1 2 3\n", 1},
                {"b.obj", v + "f -3 -2 -1\n", 1},
                {"c.obj", "f 1 2 3\n" + v, 1},
                {"d.obj", v + "f 1 2 \\\n3\n", 1},
                {"e.obj", v + "vn 0 0 1\nf 1//1 2//1 3//-1 # up\n", 1},
                {"f.obj", v + "vt 0 0\nf 1/1 2/1 3/1\n", 1},
                {"g.obj", " v 0 0 0\n\tv 1 0 0\n  v 0 1 0 # indented\nv 1 1 0\n  f 1 2 3\n\tf 2 4 3\nf 1 2 4\n", 3},
                {"h.obj", v + " f 1 2 3 # 7 8\nf 3 2 1\n", 2},
                {"i.obj", v + "f 1 2 \\\n  3 # 7 8\nf 3 2 \\\n\t1\n", 2}});
}

TEST_F(MeshCheck, BrokenObjIsRefusedByTheLine) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_refused({{"a.obj", v + "f 1 2 9\n", "line 4: names vertex 9 of 3"},
                  {"b.obj", v + "f 0 1 2\n", "'0'"},
                  {"c.obj", v + "f -1 -2 -9\n", "vertex -9"},
                  {"c2.obj", v + "f -9223372036854775808 1 2\n", "vertex -9223372036854775808 with 3 before it"},
                  {"d.obj", v + "vt 0 0\nf 1/1 2/1 3/7\n", "texture coordinate 7 of 1"},
                  {"e.obj", v + "vn 0 0 1\nf 1//1 2//1 3//7\n", "normal 7 of 1"},
                  {"f.obj", v + "f 1 2 3\nf 1 2\n", "line 5"},
                  {"g.obj", "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", "line 2"},
                  {"h.obj", v + "f 1 2 x\n", "'x'"},
                  {"i.obj", v + "f 1 2 99999999999999999999\n", "corner"},
                  {"j.obj", "v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n", "finite"}});
}

std::string binary_stl(const std::string& head, std::uint32_t count, int triangles) {
  std::string out = head;
  out.resize(80);
  append(out, count, false);
  for (int t = 0; t < triangles; ++t) {
    for (const float c : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) append(out, c, false);
    append(out, std::uint16_t{0}, false);
  }
  return out;
}
const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

TEST_F(MeshCheck, StlIsReadWhateverItsHeaderSays) {
  for (const char* head : {"made by hand", "solid of a binary file"})
    expect_sound({{"a.stl", binary_stl(head, 2, 2), 2}, {"b.stl", binary_stl(head, 2, 2) + "\n", 2}});
  expect_sound({{"c.stl", "solid t\n" + kFacet + kFacet + "endsolid t\n", 2},
                {"d.stl", "solid t\n" + kFacet + "endsolid t\nsolid u\n" + kFacet + "endsolid\n", 2}});
}

TEST_F(MeshCheck, BrokenStlIsRefused) {
  for (const char* head : {"made by hand", "solid of a binary file"}) {
    const std::string whole = binary_stl(head, 2, 2);
    expect_refused({{"a.stl", binary_stl(head, 3, 2), "says 3 triangles but has 2"},
                    {"b.stl", binary_stl(head, 1, 2), "says 1 triangles but has 2"},
                    {"c.stl", whole.substr(0, whole.size() - 7), "says 2 triangles but has 1"}});
  }
  const std::string text = "solid t\n" + kFacet + kFacet;
  std::string two = kFacet, four = kFacet;
  two.erase(two.find("vertex 0 1 0\n"), 13);
  four.insert(four.find("endloop"), "vertex 0 2 0\n");
  expect_refused({{"d.stl", text, "endsolid"},
                  {"e.stl", text.substr(0, text.size() - 40), "facet 1"},
                  {"f.stl", "solid t\n" + kFacet + two + "endsolid t\n", "facet 1"},
                  {"g.stl", "solid t\n" + kFacet + four + "endsolid t\n", "facet 1"}});
}

// 3D Studio's binary chunks: Assimp clamps an index and logs it.
TEST_F(MeshCheck, WhatAssimpClampsInOtherFormatsIsRefused) {
  const auto chunk = [](std::uint16_t id, const std::string& content) {
    std::string out;
    append(out, id, false);
    append(out, static_cast<std::uint32_t>(content.size() + 6), false);
    return out + content;
  };
  const auto mesh = [&](std::uint16_t last) {
    std::string vertices, faces;
    append(vertices, std::uint16_t{3}, false);
    for (const float c : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) append(vertices, c, false);
    append(faces, std::uint16_t{1}, false);
    for (const std::uint16_t c : {std::uint16_t{0}, std::uint16_t{1}, last, std::uint16_t{0}}) append(faces, c, false);
    const std::string object = std::string("o\0", 2) + chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces));
    return chunk(0x4d4d, chunk(0x3d3d, chunk(0x4000, object)));
  };
  expect_sound({{"a.3ds", mesh(2), 1}});
  expect_refused({{"b.3ds", mesh(9), "index"}});
}

}  // namespace
}  // namespace pliant::test
