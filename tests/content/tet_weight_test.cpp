// Weight of a soft body, against closed forms: mass, centre of mass, inertia.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "components/mass_properties.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/lattice.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

constexpr Elements kKinds[] = {Elements::kTetrahedra, Elements::kHexahedra};

Mesh weighed_mesh(const Primitive& p, const mat4& frame = mat4(1.0f)) {
  Result<BuiltMesh> built = build_mesh("test", {&p, 1}, frame);
  EXPECT_TRUE(built.ok()) << built.error().message();
  return std::move(built->mesh);
}

TetMesh filled_with(const Mesh& surface, Elements elements, double cell) {
  LatticeOptions options;
  options.cell = cell;
  options.elements = elements;
  Result<TetMesh> mesh = fill_surface(surface, options);
  EXPECT_TRUE(mesh.ok()) << mesh.error().message();
  return std::move(*mesh);
}

// Of the nodes' volumes.
MassProperties of_nodes(const TetMesh& mesh) {
  MassProperties out;
  dmat3 second(0.0);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    EXPECT_GT(mesh.volume[i], 0.0);
    out.volume += mesh.volume[i];
    out.centre += mesh.volume[i] * mesh.nodes[i];
  }
  out.centre /= out.volume;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const dvec3 r = mesh.nodes[i] - out.centre;
    second += mesh.volume[i] * glm::outerProduct(r, r);
  }
  out.inertia = dmat3(second[0][0] + second[1][1] + second[2][2]) - second;
  return out;
}

void expect_same(const MassProperties& a, const MassProperties& b, double share, const char* what) {
  EXPECT_NEAR(a.volume, b.volume, share * b.volume) << what;
  const double size = std::sqrt(b.inertia[0][0] / b.volume);
  EXPECT_LT(length(a.centre - b.centre), share * size) << what;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(a.inertia[i][j], b.inertia[i][j], share * b.inertia[0][0]) << what << i << j;
}

TEST(TetWeight, ABoxHasItsClosedFormOnAnyCell) {
  // Sides 4, 1, 1.5 about (5, 6, 7).
  mat4 frame(1.0f);
  frame[0][0] = 2.0f, frame[1][1] = 0.5f, frame[2][2] = 0.75f;
  frame[3] = vec4(5, 6, 7, 1);
  const Mesh box = weighed_mesh(test::box(vec3(1.0f), false), frame);
  const MassProperties exact{6.0, dvec3(5, 6, 7),
                             dmat3(0.5 * (1 + 2.25), 0, 0, 0, 0.5 * (16 + 2.25), 0, 0, 0, 0.5 * (16 + 1))};
  for (const Elements elements : kKinds)
    for (const double cell : {0.21, 0.3, 0.47})
      expect_same(of_nodes(filled_with(box, elements, cell)), exact, 1e-6, "box");
}

TEST(TetWeight, ASphereHasItsClosedFormOnAnyCell) {
  const Mesh sphere = weighed_mesh(test::icosphere(5));
  const double volume = 4.0 / 3.0 * std::numbers::pi;
  const MassProperties exact{volume, dvec3(0), dmat3(0.4 * volume)};
  for (const Elements elements : kKinds)
    for (const double cell : {0.2, 0.33, 0.5})
      expect_same(of_nodes(filled_with(sphere, elements, cell)), exact, 4e-3, "sphere");
}

TEST(TetWeight, ABodyOfTwoPartsIsThatOfItsTriangles) {
  Primitive two = test::icosphere(3);
  const Primitive other = test::icosphere(3);
  const auto first = static_cast<std::uint32_t>(two.position.size());
  for (const vec3 p : other.position) two.position.push_back(0.6f * p + vec3(2.5f, 0.3f, 0));
  for (const std::uint32_t i : other.index) two.index.push_back(first + i);
  const Mesh mesh = weighed_mesh(two);
  for (const Elements elements : kKinds)
    expect_same(of_nodes(filled_with(mesh, elements, 0.3)), mass_properties(mesh), 1e-6, "two");
}

}  // namespace
}  // namespace pliant
