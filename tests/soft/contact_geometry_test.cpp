// Predicted contacts against the smooth surfaces that the meshes approximate.
#include "systems/soft/collide/contact_geometry.h"

#include <gtest/gtest.h>

#include "systems/soft/body/rigid_state.h"
#include "systems/tool/tool_tick.h"
#include "tests/soft/collision_shapes.h"

namespace pliant {
namespace {

constexpr double kGeometryStep = 1.0 / 60.0;          // [s]
constexpr double kBallRadius = 0.03, kSmall = 0.012;  // [m]
constexpr dvec3 kUp{0, 1, 0};

// A collision mesh that moved by `went` in the last step and is at `at` now.
struct Going {
  Mesh mesh;
  FixedBody body;
  CollisionMesh collision_mesh;
  Going(Mesh&& shape, dvec3 at, dvec3 went) : mesh(std::move(shape)), body(mesh, Pose{}), collision_mesh(body) {
    const std::vector<dvec3> rest = body.surface_position;
    for (const dvec3 place : {at - went, at}) {
      for (std::size_t v = 0; v < rest.size(); ++v) body.surface_position[v] = rest[v] + place;
      collision_mesh.refit(body, kGeometryStep, 1e-3);
    }
  }
};

// The triangle of a sphere about the origin through which a direction passes.
std::uint32_t triangle_towards(const Mesh& mesh, dvec3 direction) {
  std::uint32_t best = 0;
  double most = -2.0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const uvec3 c = mesh.triangles[t];
    const dvec3 middle(mesh.position(c.x) + mesh.position(c.y) + mesh.position(c.z));
    const double along = dot(normalize(middle), direction);
    if (along > most) most = along, best = t;
  }
  return best;
}

double degrees_between(dvec3 a, dvec3 b) {
  return glm::degrees(std::acos(std::min(1.0, dot(normalize(a), normalize(b)))));
}

// A block's corner (sharp) over a sphere.
struct CornerOnSphere {
  Going block, sphere;
  std::uint32_t vertex = 0, triangle = 0;
  CornerOnSphere(dvec3 now, dvec3 went)
      : block(test::block_mesh(vec3(0.01f)), now - dvec3(-0.005), went),
        sphere(test::sphere_mesh(float(kBallRadius), 3), dvec3(0), dvec3(0)),
        triangle(triangle_towards(sphere.mesh, normalize(now))) {
    while (length(block.collision_mesh.vertex(vertex).x - now) > 1e-6 && vertex + 1 < block.mesh.vertex_count) ++vertex;
  }
  FeaturePair pair() const {
    return {
        block.collision_mesh, sphere.collision_mesh, false, vertex, triangle, sphere.collision_mesh.normal(triangle)};
  }
};

dmat3 axes_along(dvec3 normal) {
  const dvec3 t = normalize(cross(normal, dvec3(0, 0, 1)));
  return dmat3(normal, t, cross(normal, t));
}

// It slides 3 mm in a step.
TEST(ContactGeometry, TheNormalIsTheOneWhereTheStepEnds) {
  const dvec3 went(0.003, 0, 0.001), now = kBallRadius * normalize(dvec3(-0.002, 0.03, 0.0)), end = now + went;
  const CornerOnSphere scene(now, went);
  const FeaturePair pair = scene.pair();
  ASSERT_FALSE(pair.a.smooth(scene.vertex));
  ContactPoint contact;
  ASSERT_TRUE(look_ahead(pair, contact));
  EXPECT_LT(degrees_between(contact.normal, end), 0.5);
  EXPECT_GT(degrees_between(pair.normal, end), 4.0) << "where it began";
  // gap + T u_n is the gap at the end: the corner's height over the facets, which lie up to h^2 / 8R below the sphere.
  const double at_end = contact.gap + dot(contact.normal, went), sag = 1.5e-4;
  EXPECT_GT(at_end, length(end) - kBallRadius - 1e-5);
  EXPECT_LT(at_end, length(end) - kBallRadius + sag);

  contact.axes = axes_along(contact.normal);
  find_turning(pair, contact);
  EXPECT_GT(contact.reach, 0.0);
  for (int column = 0; column < 2; ++column)
    for (int row = 0; row < 2; ++row)
      EXPECT_NEAR(contact.turning[column][row], column == row ? 1.0 / kBallRadius : 0.0, 0.15 / kBallRadius);
}

// It has not moved yet; the step's own velocities give its next position.
TEST(ContactGeometry, TheSecondLookIsWhereTheStepsOwnVelocitiesLead) {
  const dvec3 went(0.003, 0, 0.001), now = kBallRadius * normalize(dvec3(-0.002, 0.03, 0.0)), end = now + went;
  CornerOnSphere scene(now, dvec3(0));
  ContactPoint contact;
  ASSERT_TRUE(look_ahead(scene.pair(), contact));
  EXPECT_LT(degrees_between(contact.normal, now), 0.5);
  contact.axes = axes_along(contact.normal);
  const SurfacePoint a = contact.a, b = contact.b;

  scene.block.collision_mesh.predict(
      scene.block.body, std::vector<dvec3>(scene.block.mesh.vertex_count, went / kGeometryStep), kGeometryStep);
  ASSERT_TRUE(look_again(scene.pair(), contact));
  EXPECT_LT(degrees_between(contact.normal, end), 0.5);
  EXPECT_LT(degrees_between(contact.axes * leaning_axes(contact.lean)[0], contact.normal), 1e-6);
  EXPECT_NEAR(contact.end_gap, length(end) - kBallRadius, 1.5e-4);
  EXPECT_EQ(contact.a.position, a.position) << "what pushes where is the step's first look";
  EXPECT_EQ(contact.b.position, b.position);

  scene.block.collision_mesh.refit(scene.block.body, kGeometryStep, 1e-3);
  EXPECT_LT(length(scene.block.collision_mesh.ahead(scene.vertex) - now), 1e-9) << "the next step knows nothing of it";
}

// A soft body is dented by a sliding object, and the dent moves along: curvature is that of the rest shape.
TEST(ContactGeometry, ADentDoesNotCountAsCurvature) {
  const dvec3 now = kBallRadius * kUp;
  CornerOnSphere scene(now, dvec3(0));
  std::vector<dvec3>& collision_mesh = scene.sphere.body.surface_position;
  for (dvec3& x : collision_mesh) x.y = std::min(x.y, 0.8 * kBallRadius);
  scene.sphere.collision_mesh.refit(scene.sphere.body, kGeometryStep, 1e-3);
  scene.sphere.collision_mesh.refit(scene.sphere.body, kGeometryStep, 1e-3);
  scene.block.body.surface_position[scene.vertex].y = 0.8 * kBallRadius;
  scene.block.collision_mesh.refit(scene.block.body, kGeometryStep, 1e-3);
  scene.block.collision_mesh.refit(scene.block.body, kGeometryStep, 1e-3);
  ContactPoint contact;
  ASSERT_TRUE(look_ahead(scene.pair(), contact));
  EXPECT_LT(degrees_between(contact.normal, kUp), 0.1);
  contact.axes = axes_along(contact.normal);
  find_turning(scene.pair(), contact);
  for (int column = 0; column < 2; ++column)
    for (int row = 0; row < 2; ++row)
      EXPECT_NEAR(contact.turning[column][row], column == row ? 1.0 / kBallRadius : 0.0, 0.2 / kBallRadius);
}

// Vertices of one sphere next to its contact point with another: both surfaces are inclined there, the contact is not.
TEST(ContactGeometry, BesideTheTouchingPointTheTwoSurfacesCancel) {
  const dvec3 towards = normalize(dvec3(0.2, 1.0, 0.3));
  const Going large(test::sphere_mesh(float(kBallRadius), 3), dvec3(0), dvec3(0));
  const Going little(test::sphere_mesh(float(kSmall), 2), (kBallRadius + kSmall) * towards, dvec3(0));
  int looked_at = 0;
  for (std::uint32_t v = 0; v < little.mesh.vertex_count; ++v) {
    const dvec3 x = little.collision_mesh.vertex(v).x;
    const double beside = length(x - dot(x, towards) * towards);
    if (dot(x, towards) > kBallRadius + 0.2 * kSmall || beside < 0.001 || beside > 0.004) continue;
    const std::uint32_t t = triangle_towards(large.mesh, normalize(x));
    ContactPoint contact;
    ASSERT_TRUE(look_ahead({little.collision_mesh, large.collision_mesh, false, v, t, large.collision_mesh.normal(t)},
                           contact));
    const double lean = degrees_between(-little.collision_mesh.vertex_normal(v), towards);
    EXPECT_LT(degrees_between(contact.normal, towards), 0.15 * lean) << v;
    ++looked_at;
  }
  EXPECT_GT(looked_at, 3);
}

// For a body at rest the prediction is no motion.
TEST(ContactGeometry, WhatStopsIsForetoldWhereItStands) {
  Going block(test::block_mesh(vec3(0.01f)), dvec3(0.02, 0, 0), dvec3(0.003, 0, 0.001));
  for (int i = 0; i < 3; ++i) block.collision_mesh.refit(block.body, kGeometryStep, 1e-3);
  for (std::uint32_t v = 0; v < block.mesh.vertex_count; ++v)
    EXPECT_LT(length(block.collision_mesh.ahead(v) - block.collision_mesh.vertex(v).x), 1e-12) << v;
}

// Faster than the surface's triangles are large: such a motion will not go on, and nothing is predicted.
TEST(ContactGeometry, AnImpactIsNotForetold) {
  const dvec3 now = (kBallRadius + 0.001) * kUp, went(0, -0.008, 0), corner(-0.005, -0.005, -0.005);
  Going block(test::block_mesh(vec3(0.01f)), now - corner, went);
  const Going sphere(test::sphere_mesh(float(kBallRadius), 3), dvec3(0), dvec3(0));
  std::uint32_t vertex = 0;
  while (length(block.collision_mesh.vertex(vertex).x - now) > 1e-6) ASSERT_LT(++vertex, block.mesh.vertex_count);
  const std::uint32_t t = triangle_towards(sphere.mesh, kUp);
  ContactPoint contact;
  EXPECT_FALSE(look_ahead(
      {block.collision_mesh, sphere.collision_mesh, false, vertex, t, sphere.collision_mesh.normal(t)}, contact));
}

// A pad of springs carried straight over a bump of curvature k loses k s^2 / 2 of its depth by a slip s.
TEST(ContactGeometry, ACondensedContactFollowsTheBump) {
  const double curvature = 40.0, flexibility = 1e-3, pressed = 2.0, speed = 0.05;  // [1/m], [m/N], [N], [m/s]
  CondensedContacts model;
  model.resize(kMaxCondensed, kMaxModes);
  model.count = 1;
  model.modes = 0;
  model.from_handle.setZero();
  model.from_handle(0, 1) = model.from_handle(1, 0) = model.from_handle(2, 2) = 1.0;
  model.flexibility.setZero();
  for (int k = 0; k < 3; ++k) model.flexibility(k, k) = k == 0 ? flexibility : 1e-6 * flexibility;
  model.force.setZero();
  model.force[0] = pressed;
  model.gap.setZero();
  model.push.setZero();
  model.mu_static[0] = model.mu_sliding[0] = 0.0;
  model.turning[0] = dmat2(curvature, 0, 0, curvature);
  model.prepare_tick(1e-3);
  CondensedState state;
  state.resize(kMaxCondensed, kMaxModes);
  state.start(model);
  TickHandle handle;
  handle.moved = true;
  handle.next = handle.velocity = join(dvec3(speed, 0, 0), dvec3(0));
  Vector6 wrench;
  const int ticks = 100;
  for (int i = 0; i < ticks; ++i) wrench = condensed_tick(model, state, {50, 1e-9, 0}, handle);
  const double slip = ticks * 1e-3 * speed, left = pressed - 0.5 * curvature * slip * slip / flexibility;
  EXPECT_NEAR(state.slip[0].x, slip, 0.02 * slip);
  EXPECT_NEAR(wrench[1], left, 0.02 * pressed);
  EXPECT_NEAR(std::atan2(wrench[0], wrench[1]), std::atan(curvature * slip), 0.02) << "pushed on, down the slope";
  EXPECT_LT(left, 0.8 * pressed);
}

}  // namespace
}  // namespace pliant
