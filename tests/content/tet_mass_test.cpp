// Mass properties of surfaces against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "components/mass_properties.h"
#include "content/mesh/mesh_build.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

MassProperties of(const Primitive& p, const mat4& to_object = mat4(1.0f)) {
  Result<BuiltMesh> built = build_mesh("test", {&p, 1}, to_object);
  EXPECT_TRUE(built.ok()) << built.error().message();
  return mass_properties(built->mesh);
}

Primitive unit_box() {
  Primitive p;
  for (int i = 0; i < 8; ++i) p.position.emplace_back(float(i & 1), float(i >> 1 & 1), float(i >> 2));
  p.index = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
             2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  return p;
}

void expect_near(const dmat3& a, const dmat3& b, double tolerance) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(a[i][j], b[i][j], tolerance) << i << ' ' << j;
}

TEST(MassProperties, ABoxWherePlacedHasItsClosedForm) {
  // Sides 2, 3, 4 from (5, 6, 7): V = 24, I_x = V (b^2 + c^2)/12.
  mat4 frame = glm::mat4(1.0f);
  for (int i = 0; i < 3; ++i) frame[i][i] = float(2 + i);
  frame[3] = vec4(5, 6, 7, 1);
  const MassProperties box = of(unit_box(), frame);
  EXPECT_NEAR(box.volume, 24.0, 1e-12);
  EXPECT_LT(length(box.centre - dvec3(6, 7.5, 9)), 1e-12);
  expect_near(box.inertia, dmat3(24.0 / 12 * (9 + 16), 0, 0, 0, 24.0 / 12 * (4 + 16), 0, 0, 0, 24.0 / 12 * (4 + 9)),
              1e-11);
}

TEST(MassProperties, ATetrahedronHasItsClosedFormWithProducts) {
  // Corners 0, x, y, z of length 1: V = 1/6, centre 1/4; about the centre the second moments are
  // V/20 (sum of v v^T over the corners from the centre): diagonal 1/160, others -1/480.
  Primitive p;
  p.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  p.index = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
  const MassProperties tet = of(p);
  EXPECT_NEAR(tet.volume, 1.0 / 6.0, 1e-15);
  EXPECT_LT(length(tet.centre - dvec3(0.25)), 1e-15);
  const double on = 2.0 / 160.0, off = 1.0 / 480.0;
  expect_near(tet.inertia, dmat3(on, off, off, off, on, off, off, off, on), 1e-15);
}

TEST(MassProperties, ASphereConvergesToTwoFifthsOfTheRadiusSquared) {
  double before = 0.0;
  for (const int levels : {2, 3, 4}) {
    const MassProperties sphere = of(test::icosphere(levels));
    const double error = std::abs(sphere.inertia[0][0] / (0.4 * 4.0 / 3.0 * std::numbers::pi) - 1.0);
    if (before > 0.0) EXPECT_NEAR(before / error, 4.0, 0.2) << "second order";
    before = error;
    EXPECT_LT(length(sphere.centre), 1e-6);
  }
}

TEST(MassProperties, TurningTheBodyTurnsItsTensorAndASurfaceInsideOutWeighsTheSame) {
  mat4 frame(1.0f);
  frame[1][1] = 3.0f;
  const MassProperties still = of(unit_box(), frame);
  const quat turn = glm::angleAxis(0.8f, normalize(vec3(1, -2, 0.5f)));
  const MassProperties turned = of(unit_box(), glm::mat4_cast(turn) * frame);
  const dmat3 r = glm::mat3_cast(dquat(turn));
  expect_near(turned.inertia, r * still.inertia * glm::transpose(r), 1e-6);

  Primitive inside_out = unit_box();
  for (std::size_t i = 0; i < inside_out.index.size(); i += 3) std::swap(inside_out.index[i], inside_out.index[i + 1]);
  const MassProperties other = of(inside_out, frame);
  EXPECT_EQ(other.volume, still.volume);
  expect_near(other.inertia, still.inertia, 1e-12);
}

TEST(MassProperties, ASheetHasNone) {
  EXPECT_EQ(of(test::sheet(3)).volume, 0.0);
}

}  // namespace
}  // namespace pliant
