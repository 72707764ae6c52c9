// Tetrahedra files: every format of the same mesh gives the same result, errors name their place, damaged files never
// crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include "content/mesh/mesh_build.h"
#include "content/openable.h"
#include "content/tets/lattice.h"
#include "content/tets/tet_boundary.h"
#include "content/tets/tet_quality.h"
#include "tests/content/mesh_shapes.h"
#include "tests/content/tet_writers.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using test::NodesAndTets;
using testing::HasSubstr;

std::span<const std::uint8_t> bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

using Parse = std::function<Result<TetFile>(const std::string&)>;
Result<TetFile> msh(const std::string& text) {
  return parse_msh(bytes(text), "f.msh");
}
Result<TetFile> vtk(const std::string& text) {
  return parse_vtk(bytes(text), "f.vtk");
}
// The pair as one text, with a byte of 1 between its halves.
Result<TetFile> tetgen(const std::string& text) {
  const std::size_t split = std::min(text.find('\1'), text.size());
  const std::string node = text.substr(0, split), ele = text.substr(std::min(split + 1, text.size()));
  return parse_tetgen(bytes(node), bytes(ele), "f");
}

struct Form {
  const char* name;
  Parse parse;
  std::string text;
};
std::vector<Form> forms_of(const NodesAndTets& mesh) {
  const auto zero = test::tetgen(mesh, 0), one = test::tetgen(mesh, 1);
  return {{"msh 2.2 ASCII", msh, test::msh_2(mesh, false, false)},
          {"msh 2.2 binary", msh, test::msh_2(mesh, true, false)},
          {"msh 2.2 binary, foreign", msh, test::msh_2(mesh, true, true)},
          {"msh 4.1 ASCII", msh, test::msh_4(mesh, false, false)},
          {"msh 4.1 binary", msh, test::msh_4(mesh, true, false)},
          {"msh 4.1 binary, foreign", msh, test::msh_4(mesh, true, true)},
          {"vtk 3 ASCII", vtk, test::vtk(mesh, false, false)},
          {"vtk 3 binary", vtk, test::vtk(mesh, true, false)},
          {"vtk 5 ASCII", vtk, test::vtk(mesh, false, true)},
          {"vtk 5 binary", vtk, test::vtk(mesh, true, true)},
          {"TetGen from 0", tetgen, zero.first + '\1' + zero.second},
          {"TetGen from 1", tetgen, one.first + '\1' + one.second}};
}

NodesAndTets ball(double cell) {
  const Primitive sphere = test::icosphere(2);
  const Result<BuiltMesh> built = build_mesh("ball", {&sphere, 1}, mat4(1.0f));
  const Result<TetMesh> mesh = make_lattice(built->mesh, cell);
  return {mesh->nodes, mesh->tets};
}
const NodesAndTets kOne{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {Tet{0, 1, 2, 3}}};

void expect_sound(const TetFile& file) {
  ASSERT_FALSE(file.tets.empty());
  for (const dvec3& p : file.nodes) ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  for (const Tet& t : file.tets) {
    for (const std::uint32_t corner : t) ASSERT_LT(corner, file.nodes.size());
    ASSERT_GT(tet_volume(file.nodes, t), 0.0);
  }
}

TEST(TetFile, EveryFormOfAMeshReadsAsThatMeshToTheBit) {
  const NodesAndTets mesh = ball(0.4);
  for (const Form& form : forms_of(mesh)) {
    const Result<TetFile> file = form.parse(form.text);
    ASSERT_TRUE(file.ok()) << form.name << ": " << file.error().message();
    EXPECT_EQ(file->nodes, mesh.first) << form.name;
    EXPECT_EQ(file->tets, mesh.second) << form.name;
    const bool has_triangle = std::string(form.name).find("TetGen") == std::string::npos;
    EXPECT_EQ(file->notes.size(), has_triangle ? 1u : 0u) << form.name;
  }
}

TEST(TetFile, InvertedFlatHigherOrderAndUnusedPartsAreMendedAndNoted) {
  const Result<TetFile> file =
      msh("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n12\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 9 9 9\n6 1 1 0\n"
          "7 .5 0 0\n8 .5 .5 0\n9 0 .5 0\n10 0 0 .5\n11 0 .5 .5\n12 .5 0 .5\n$EndNodes\n$Elements\n5\n"
          "1 15 2 0 0 1\n2 4 2 0 0 1 3 2 4\n3 4 2 0 0 1 2 3 6\n4 11 2 0 0 1 2 3 4 7 8 9 10 11 12\n5 999 2 0 0 1 2 3\n"
          "$EndElements\n");
  ASSERT_TRUE(file.ok()) << file.error().message();
  EXPECT_EQ(file->nodes.size(), 4u);
  ASSERT_EQ(file->tets.size(), 2u);
  for (const Tet& t : file->tets) EXPECT_DOUBLE_EQ(tet_volume(file->nodes, t), 1.0 / 6.0);
  EXPECT_THAT(file->notes,
              testing::UnorderedElementsAre(HasSubstr("1 tetrahedron of higher order"),
                                            HasSubstr("2 cells that are no"), HasSubstr("1 inverted"),
                                            HasSubstr("1 tetrahedron without volume"), HasSubstr("8 nodes that no")));
}

TEST(TetFile, AFalseClaimOfCellEntriesIsOverlooked) {
  std::string text = test::vtk(kOne, false, false);
  text.replace(text.find("CELLS 2 9"), 9, "CELLS 2 2");
  const Result<TetFile> file = vtk(text);
  ASSERT_TRUE(file.ok()) << file.error().message();
  EXPECT_EQ(file->tets.size(), 1u);
}

TEST(TetFile, FaultsAreReportedInOneSentenceWithTheirPlace) {
  const auto expect = [](const Parse& parse, std::string text, const char* from, const char* to, const char* where,
                         const char* what) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    const Result<TetFile> file = parse(text.replace(at, std::strlen(from), to));
    ASSERT_FALSE(file.ok()) << to;
    EXPECT_THAT(file.error().where, HasSubstr(where)) << file.error().message();
    EXPECT_THAT(file.error().sentence(), HasSubstr(what));
    EXPECT_THAT(file.error().message(), testing::Not(HasSubstr("\n")));
  };
  const std::string two = test::msh_2(kOne, false, false), four = test::msh_4(kOne, false, false),
                    old = test::vtk(kOne, false, false),
                    pair = test::tetgen(kOne, 1).first + '\1' + test::tetgen(kOne, 1).second;
  expect(msh, two, "2.2 0 8", "1.0 0 8", "f.msh:2", "save it as 4.1 or 2.2");
  expect(msh, two, "2.2 0 8", "2.2 0 4", "f.msh:2", "8");
  expect(msh, two, "9 1 0 0", "9 nan 0 0", "f.msh:11", "finite");
  expect(msh, two, "9 1 0 0", "9 1e999 0 0", "f.msh:11", "finite");
  expect(msh, two, "9 1 0 0", "7 1 0 0", "f.msh", "two nodes of tag 7");
  expect(msh, two, "$Nodes\n4", "$Nodes\n4000000000", "f.msh:9", "claims 4000000000 nodes");
  expect(msh, two, "$Elements\n2", "$Elements\n9999999", "f.msh", "claims 9999999 elements");
  expect(msh, two, "7 9 11 13", "7 9 11 99", "f.msh:19", "names node 99");
  expect(msh, two, "$EndElements", "", "f.msh", "cut short");
  expect(msh, four, "3 1 4 1", "3 1 4 7", "f.msh", "damaged head of element block 2");
  expect(msh, test::msh_4(kOne, true, false), "$EndElements", "$EndElement!", "at byte", "cut short");
  expect(vtk, old, "UNSTRUCTURED_GRID", "POLYDATA", "f.vtk:4", "unstructured grid");
  expect(vtk, old, "3.0", "9.0", "f.vtk", "version");
  expect(vtk, old, "4 0 1 2 3", "4 0 1 2 -3", "f.vtk", "names point -3 of 4");
  expect(vtk, old, "4 0 1 2 3", "3 0 1 2", "f.vtk", "tetrahedron of 3 nodes");
  expect(vtk, old, "CELL_TYPES 2", "CELL_TYPES 1", "f.vtk", "has 2 CELLS but 1 CELL_TYPES");
  expect(vtk, old, "POINTS 4", "POINTS -4", "f.vtk:8", "POINTS");
  expect(vtk, old, "POINTS 4", "POINTS 40", "f.vtk", "point 4 of 40");
  expect(tetgen, pair, "4 3 1 1", "4 2 1 1", "f.node:3", "points 3");
  expect(tetgen, pair, "2 1 0 0", "3 1 0 0", "f.node:5", "numbers node 3 where 2 follows");
  expect(tetgen, pair, "1 1 2 3 4", "1 1 2 3 5", "f.ele:2", "names node 5");
  expect(tetgen, pair, "1 4 0", "1 5 0", "f.ele:1", "tetrahedra 4");
  expect(tetgen, pair, "1 1 2 3 4", "1 1 2 3 3", "f", "without volume");
  EXPECT_THAT(load_tets("mesh.obj").error().message(), HasSubstr("formats are: .msh"));
  EXPECT_THAT(load_tets("no/such.msh").error().message(), HasSubstr("no such file"));
}

TEST(TetFile, TruncatedAndFlippedFilesAreReadSoundlyOrRefusedInOneSentence) {
  std::mt19937 random(11);
  for (const Form& form : forms_of(ball(0.9))) {
    const auto check = [&](const std::string& text) {
      const Result<TetFile> file = form.parse(text);
      if (file)
        expect_sound(*file);
      else
        ASSERT_FALSE(file.error().what.empty());
    };
    for (std::size_t size = 0; size < form.text.size(); size += 1 + size / 40) check(form.text.substr(0, size));
    for (int n = 0; n < 300; ++n) {
      std::string text = form.text;
      for (int flips = 1 + n % 3; flips > 0; --flips) text[random() % text.size()] = static_cast<char>(random());
      check(text);
    }
  }
}

TEST(TetFile, EveryMeshOfTheCorpusLoads) {
  const fs::path corpus = fs::path(PLIANT_CORPUS_DIR) / "tet-meshes";
  if (!fs::exists(corpus)) GTEST_SKIP() << "the corpus is not beside the project";
  int count = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(corpus)) {
    if (!entry.is_regular_file() || !is_tet_file(entry.path())) continue;
    const Result<TetFile> file = load_tets(entry.path());
    ASSERT_TRUE(file.ok()) << file.error().message();
    expect_sound(*file);
    // The elements' volume equals that enclosed by their boundary: no overlap.
    double volume = 0.0, within = 0.0;
    for (const Tet& t : file->tets) volume += tet_volume(file->nodes, t);
    for (const uvec3& t : boundary_triangles(file->tets))
      within += dot(file->nodes[t.x], cross(file->nodes[t.y], file->nodes[t.z])) / 6.0;
    EXPECT_NEAR(within, volume, 1e-9 * volume) << entry.path();
    ++count;
  }
  EXPECT_EQ(count, 19);
}

TEST(TetQuality, AgreesWithClosedForms) {
  const double s = std::sqrt(0.5);
  const std::vector<dvec3> regular{{1, 0, -s}, {-1, 0, -s}, {0, 1, s}, {0, -1, s}}, corner = kOne.first;
  const std::vector<Tet> tet{Tet{0, 1, 2, 3}}, turned{Tet{0, 1, 3, 2}};
  const TetQuality best = measure_quality(regular, tet_volume(regular, tet[0]) > 0.0 ? tet : turned);
  EXPECT_NEAR(best.smallest_dihedral, std::acos(1.0 / 3.0), 1e-12);
  EXPECT_NEAR(best.largest_dihedral, std::acos(1.0 / 3.0), 1e-12);
  EXPECT_NEAR(best.worst_ratio, 1.0, 1e-12);
  // A cube's corner: right angles, acos(1/sqrt 3); r = 1/(3 + sqrt 3), R = sqrt 3/2.
  const TetQuality right = measure_quality(corner, tet);
  EXPECT_NEAR(right.smallest_dihedral, std::acos(1.0 / std::sqrt(3.0)), 1e-12);
  EXPECT_NEAR(right.largest_dihedral, std::acos(0.0), 1e-12);
  EXPECT_NEAR(right.median_ratio, 6.0 / (std::sqrt(3.0) * (3.0 + std::sqrt(3.0))), 1e-12);
}

// One list for readers, the file browser, dropped files and messages.
TEST(TetFile, EveryEndingIsReadOpenedAndDocumented) {
  std::ifstream file(std::string(PLIANT_SOURCE_DIR) + "/docs/level-format.md");
  const std::string docs(std::istreambuf_iterator<char>(file), {});
  for (const std::string& ending : tet_endings()) {
    std::string upper = ending;
    std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
    EXPECT_TRUE(is_tet_file("a" + ending) && is_tet_file("a" + upper)) << ending;
    EXPECT_TRUE(has_ending("a" + upper, openable_endings())) << ending;
    EXPECT_THAT(docs, HasSubstr("`" + ending + "`"));
    EXPECT_THAT(load_tets("mesh.obj").error().message(), HasSubstr(ending));
  }
  for (const std::string& ending : mesh_endings()) EXPECT_FALSE(is_tet_file("a" + ending)) << ending;
}

}  // namespace
}  // namespace pliant
