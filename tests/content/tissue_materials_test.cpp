// Materials of the parts of a soft body: paint, physical groups, a mesh inside.
#include "content/level/tissue_materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "content/tets/tet_file.h"
#include "content/tets/tet_quality.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

// A block of side 2 about the origin, and a ball of radius 0.5 in it, as a level.
struct Lumpy {
  explicit Lumpy(Elements elements, Primitive block = test::box(vec3(1.0f), false)) {
    level.nodes.resize(2);
    level.meshes.resize(2);
    level.meshes[0].primitives = {std::move(block)};
    Primitive ball = test::icosphere(3);
    for (vec3& p : ball.position) p *= 0.5f;
    level.meshes[1].primitives = {ball};
    SoftBody& body = level.nodes[0].soft_body.emplace();
    body.young = 1000.0, body.density = 1000.0, body.cell = 0.25, body.elements = elements;
    level.nodes[0].name = "block", level.nodes[1].name = "lump";
    level.nodes[0].mesh = 0, level.nodes[1].mesh = 1;
    level.nodes[0].in_scene = level.nodes[1].in_scene = true;
    Result<SoftParts> made = make_soft_parts(level.nodes[0], &level.meshes[0], mat4(1), {});
    EXPECT_TRUE(made.ok());
    parts = std::move(*made);
  }
  Status set() { return set_materials(level, level.nodes[0], dmat4(1), {dmat4(1), dmat4(1)}, parts); }
  SoftBody& body() { return *level.nodes[0].soft_body; }
  double element_volume(std::size_t e) const {
    if (parts.tets.cells.empty()) return tet_volume(parts.tets.nodes, parts.tets.tets[e]);
    double sum = 0.0;
    for (std::size_t k = 0; k < kTetsOfCell; ++k)
      sum += tet_volume(parts.tets.nodes, parts.tets.tets[kTetsOfCell * e + k]);
    return sum;
  }
  dvec3 middle(std::size_t e) const {
    dvec3 sum(0);
    const std::size_t each = parts.tets.cells.empty() ? 1 : kTetsOfCell;
    for (std::size_t k = 0; k < each; ++k)
      for (const std::uint32_t n : parts.tets.tets[each * e + k]) sum += parts.tets.nodes[n];
    return sum / (4.0 * static_cast<double>(each));
  }
  Level level;
  SoftParts parts;
};

TEST(TissueMaterials, AMeshInsideIsAsStiffAndHeavyAsItsVolume) {
  for (const Elements elements : {Elements::kTetrahedra, Elements::kHexahedra}) {
    Lumpy its(elements);
    its.body().materials = {{.name = "lump", .young = 5000.0, .density = 3000.0, .damping = 2.0}};
    const Status set = its.set();
    ASSERT_TRUE(set.ok()) << set.error().message();
    const double ball = 4.0 / 3.0 * std::numbers::pi * 0.125;
    double stiff = 0.0, damped = 0.0;
    for (std::size_t e = 0; e < its.parts.tets.factors.size(); ++e) {
      stiff += its.element_volume(e) * (its.parts.tets.factors[e].stiffness - 1.0) / 4.0;
      damped += its.element_volume(e) * (its.parts.tets.factors[e].damping - 1.0);
      if (length(its.middle(e)) > 0.9) EXPECT_EQ(its.parts.tets.factors[e].stiffness, 1.0);
      if (length(its.middle(e)) < 0.2) EXPECT_EQ(its.parts.tets.factors[e].stiffness, 5.0);
    }
    EXPECT_NEAR(stiff, ball, 0.03 * ball);
    EXPECT_NEAR(damped, ball, 0.03 * ball);
    const std::vector<double>& volume = its.parts.tets.volume;
    EXPECT_NEAR(std::accumulate(volume.begin(), volume.end(), 0.0), 8.0 + 2.0 * ball, 0.05 * ball);
  }
}

TEST(TissueMaterials, PaintReachesInwardsFromTheNearestPlaceOfTheSurface) {
  for (const Elements elements : {Elements::kTetrahedra, Elements::kHexahedra}) {
    Primitive block = test::box(vec3(1.0f), false);
    for (const vec3 p : block.position) {
      block.stiffness.push_back(2.0f + p.x);  // 1 to 3 along x
      block.damping.push_back(4.0f);
      block.friction.push_back(2.0f);
    }
    Lumpy its(elements, block);
    ASSERT_TRUE(its.set().ok());
    for (std::size_t e = 0; e < its.parts.tets.factors.size(); ++e) {
      const dvec3 at = its.middle(e);
      const double away = 1.0 - std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)});
      EXPECT_NEAR(its.parts.tets.factors[e].stiffness, 2.0 + at.x, away + 1e-5);
      EXPECT_NEAR(its.parts.tets.factors[e].damping, 4.0, 1e-5);
    }
    bool said = false;
    for (const Note& note : its.parts.tets.report.notes)
      said = said || note.what.find("_FRICTION") != std::string::npos;
    EXPECT_TRUE(said);
  }
}

TEST(TissueMaterials, ANameThatIsNothingIsRefused) {
  Lumpy its(Elements::kTetrahedra);
  its.body().materials = {{.name = "stone", .young = 5000.0}};
  const Status set = its.set();
  ASSERT_FALSE(set.ok());
  EXPECT_NE(set.error().message().find("`stone`"), std::string::npos) << set.error().message();
}

TEST(TissueMaterials, GroupsOfAGmshFileAreReadByNameInBothVersions) {
  const std::string names = "$PhysicalNames\n2\n3 7 \"fat\"\n3 9 \"tumour\"\n$EndPhysicalNames\n";
  const std::string two = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names +
                          "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n"
                          "$Elements\n2\n1 4 2 9 1 1 2 3 4\n2 4 2 7 1 2 3 4 5\n$EndElements\n";
  const std::string four = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + names +
                           "$Entities\n0 0 0 2\n1 0 0 0 1 1 1 1 9 0\n2 0 0 0 1 1 1 1 7 0\n$EndEntities\n"
                           "$Nodes\n1 5 1 5\n3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n"
                           "$Elements\n2 2 1 2\n3 1 4 1\n1 1 2 3 4\n3 2 4 1\n2 2 3 4 5\n$EndElements\n";
  for (const std::string& text : {two, four}) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    const Result<TetFile> file = parse_msh({bytes, text.size()}, "groups.msh");
    ASSERT_TRUE(file.ok()) << file.error().message();
    ASSERT_EQ(file->groups, (std::vector<std::string>{"fat", "tumour"}));
    EXPECT_EQ(file->group, (std::vector<std::uint16_t>{2, 1}));
  }
}

TEST(TissueMaterials, AGroupIsAMaterialAndOneWithoutIsSaid) {
  Lumpy its(Elements::kTetrahedra);
  its.parts.groups = {"fat", "tumour"};
  for (std::size_t e = 0; e < its.parts.tets.tets.size(); ++e)
    its.parts.tets.group.push_back(its.middle(e).x > 0 ? std::uint16_t{2} : std::uint16_t{1});
  its.body().materials = {{.name = "tumour", .young = 7000.0}};
  ASSERT_TRUE(its.set().ok());
  for (std::size_t e = 0; e < its.parts.tets.factors.size(); ++e)
    EXPECT_EQ(its.parts.tets.factors[e].stiffness, its.middle(e).x > 0 ? 7.0 : 1.0);
  ASSERT_FALSE(its.parts.tets.report.notes.empty());
  EXPECT_NE(its.parts.tets.report.notes.back().what.find("`fat`"), std::string::npos);
}

}  // namespace
}  // namespace pliant
