// Bodies at rest in grooves, bowls and corners: wall forces satisfy statics, normals are the walls' own, nothing sinks
// in or creeps. Grooves and bowls also as sheets.
#include <gtest/gtest.h>

#include <cmath>

#include "content/tets/lattice.h"
#include "systems/soft/body/soft_body_state.h"
#include "tests/soft/collision_shapes.h"
#include "tests/soft/contact_loop.h"

namespace pliant {
namespace {

using test::ContactLoop;
constexpr double kConcaveStep = 1.0 / 60.0;  // [s]
constexpr double kConcaveGravity = 9.81;     // [m/s2]
constexpr float kBowlRadius = 0.02f;         // [m] of the ball
constexpr double kMass = 0.05;               // [kg] of the rigid one

// A ball in a fixed hollow: rigid, or of tissue.
struct Rest {
  Mesh ball = test::sphere_mesh(kBowlRadius, 3);
  Mesh hollow;
  TetMesh tets;
  ContactLoop loop;
  Body* body = nullptr;
  double weight = kMass * kConcaveGravity;  // [N]

  Rest(Mesh ground, bool soft, dvec3 at, double friction) : hollow(std::move(ground)) {
    loop.add<FixedBody>(hollow, Pose{});
    if (soft) {
      auto made = make_lattice(ball, 0.008);
      EXPECT_TRUE(made);
      tets = std::move(*made);
      const SoftBody tissue{{.young = 2e4, .poisson = 0.4, .density = 1000.0, .rayleigh = {0.0, 0.02}}};
      auto& state = loop.add<SoftBodyState>(tets, ball, tissue, nullptr, Pose{at}, SolverKind::kAuto);
      weight = 0.0;
      for (const double m : state.tissue().mass()) weight += m * kConcaveGravity;
      body = &state;
    } else {
      body = &loop.add<RigidState>(ball, Pose{at}, test::sphere_mass(kBowlRadius, kMass));
    }
    loop.set_friction(friction, friction);
  }
  void run(double seconds) {
    for (int i = 0; i < int(std::lround(seconds / kConcaveStep)); ++i) loop.step(kConcaveStep);
  }
  dvec3 centre() const {
    dvec3 sum(0);
    for (const dvec3& x : body->surface_position) sum += x;
    return sum / double(body->surface_position.size());
  }
  dvec3 normal(const ContactPoint& c) const { return c.body_a == 1 ? c.normal : -c.normal; }
  dvec3 force() const { return loop.force(1, 0); }  // [N] on the ball
  double pressed_by(dvec3 wall) const {             // [N] along the normal of a wall
    double sum = 0;
    for (const ContactPoint& c : loop.contacts)
      if (dot(normal(c), wall) > 0.999) sum += c.impulse.x / kConcaveStep;
    return sum;
  }
  double tilted() const {  // [N] at most, off the walls: contacts with a tissue's facets lean by up to some mrad
    double sum = 0;
    for (const ContactPoint& c : loop.contacts) {
      const dvec3 n = glm::abs(normal(c));
      sum += c.impulse.x / kConcaveStep * std::sqrt(std::max(0.0, 1 - std::pow(std::max({n.x, n.y, n.z}), 2)));
    }
    return sum;
  }
  double pressed() const {  // [N] along all normals
    double sum = 0;
    for (const ContactPoint& c : loop.contacts) sum += c.impulse.x / kConcaveStep;
    return sum;
  }
  // [m] the ball's deepest vertex behind the surface y = height(x, z).
  template <class Height>
  double depth(Height height, double cosine) const {
    double deepest = -1.0;
    for (const dvec3& x : body->surface_position) deepest = std::max(deepest, (height(x.x, x.z) - x.y) * cosine);
    return deepest;
  }
};

// Two walls, each inclined by `angle`, bear W / (2 cos angle) where nothing rubs.
TEST(ConcaveContact, WallsOfAGrooveShareTheWeightByTheirInclination) {
  for (const double angle : {0.3, 0.7, 1.1})
    for (const bool soft : {false, true})
      for (const bool open : {false, true}) {
        if (soft && open && angle != 0.7) continue;
        const auto walls = [&](auto x, auto) { return std::abs(x) * static_cast<decltype(x)>(std::tan(angle)); };
        Rest rest(test::relief_mesh(0.16f, 8, -0.05f, open, walls), soft,
                  dvec3(0.0, 1.05 * kBowlRadius / std::cos(angle), 0.003), 0.0);
        rest.run(2.5);
        SCOPED_TRACE(testing::Message() << "angle " << angle << ", soft " << soft << ", open " << open);
        const double each = rest.weight / (2.0 * std::cos(angle)), error = (soft ? 0.01 : 1e-3) * each;
        for (const double side : {-1.0, 1.0})
          EXPECT_NEAR(rest.pressed_by(dvec3(side * std::sin(angle), std::cos(angle), 0)), each, error) << side;
        EXPECT_NEAR(rest.pressed(), 2 * each, 2 * error) << "something else presses, too";
        EXPECT_LT(length(rest.force() - dvec3(0, rest.weight, 0)), error);
      }
}

// With friction how the walls share is a matter of history; that it rests is not.
TEST(ConcaveContact, WhatLiesInAGrooveNeitherSinksInNorCreeps) {
  const double angle = 0.7;
  for (const bool soft : {false, true})
    for (const bool open : {false, true}) {
      const auto walls = [&](auto x, auto) { return std::abs(x) * static_cast<decltype(x)>(std::tan(angle)); };
      Rest rest(test::relief_mesh(0.16f, 8, -0.05f, open, walls), soft,
                dvec3(0.0, 1.05 * kBowlRadius / std::cos(angle), 0.003), 0.4);
      rest.run(2.0);
      const dvec3 settled = rest.centre();
      rest.run(2.0);
      SCOPED_TRACE(testing::Message() << "soft " << soft << ", open " << open);
      EXPECT_LT(length(rest.centre() - settled), 1e-6);
      EXPECT_LT(rest.depth(walls, std::cos(angle)), soft ? 2e-5 : 1e-7);
      EXPECT_LT(length(rest.force() - dvec3(0, rest.weight, 0)), 1e-4 * rest.weight);
    }
}

// A paraboloid: the ball comes to rest at its bottom, with normals towards the ball all the way.
TEST(ConcaveContact, ABallRollsToTheBottomOfABowlAndStays) {
  const auto bowl = [](auto x, auto z) { return (x * x + z * z) / static_cast<decltype(x)>(0.08); };
  for (const bool soft : {false, true})
    for (const bool open : {false, true}) {
      if (soft && open) continue;
      Rest rest(test::relief_mesh(0.12f, 12, -0.03f, open, bowl), soft, dvec3(0.02, 0.035, 0.01), 0.4);
      SCOPED_TRACE(testing::Message() << "soft " << soft << ", open " << open);
      for (int i = 0; i < 120; ++i) {
        rest.loop.step(kConcaveStep);
        for (const ContactPoint& c : rest.loop.contacts) {
          const SurfacePoint& mine = c.body_a == 1 ? c.a : c.b;
          EXPECT_GT(dot(rest.normal(c), normalize(rest.centre() - mine.position)), 0.7) << i;
        }
      }
      const dvec3 settled = rest.centre();
      rest.run(1.0);
      EXPECT_LT(length(rest.centre() - settled), 1e-5);
      EXPECT_LT(std::hypot(settled.x, settled.z), 1e-3);  // a tenth of a facet of the bowl
      // A facet's sagitta lower than the paraboloid at most: (10 mm)^2 / 80 mm / 2.
      EXPECT_NEAR(settled.y, kBowlRadius, 1.3e-3);
      EXPECT_LT(length(rest.force() - dvec3(0, rest.weight, 0)), 1e-3 * rest.weight);
    }
}

// Three walls at right angles bear the three components of gravity.
TEST(ConcaveContact, ACornersWallsBearTheComponentsOfTheWeight) {
  const Mesh corner = test::voxel_mesh(2, 2, 2, vec3(0.06f), vec3(-0.06f),
                                       [](int i, int j, int k) { return i == 0 || j == 0 || k == 0; });
  for (const bool soft : {false, true})
    for (const double friction : {0.0, 0.4}) {
      Rest rest(corner, soft, dvec3(1.1 * kBowlRadius), friction);
      const dvec3 down = -normalize(dvec3(1, 2, 3));
      rest.loop.gravity = kConcaveGravity * down;
      rest.run(2.0);
      const dvec3 settled = rest.centre();
      rest.run(1.0);
      SCOPED_TRACE(testing::Message() << "soft " << soft << ", friction " << friction);
      EXPECT_LT(length(rest.centre() - settled), 1e-6);
      EXPECT_LT(length(rest.force() + rest.weight * down), 1e-4 * rest.weight);
      for (int wall = 0; wall < 3; ++wall) {
        dvec3 normal(0);
        normal[wall] = 1.0;
        const double component = -rest.weight * down[wall];
        if (friction == 0.0)
          EXPECT_NEAR(rest.pressed_by(normal), component, rest.tilted() + 1e-4 * rest.weight) << wall;
        for (const dvec3& x : rest.body->surface_position) ASSERT_GT(x[wall], -2e-5);
      }
    }
}

// A block pushed into the corner of an L lies with two of its faces on the walls.
TEST(ConcaveContact, ABlockLiesFlatInTheCornerOfAnL) {
  const Mesh corner = test::voxel_mesh(2, 2, 1, vec3(0.1f, 0.1f, 0.2f), vec3(-0.1f, -0.1f, -0.1f),
                                       [](int i, int j, int) { return i == 0 || j == 0; });
  const Mesh block = test::block_mesh(vec3(0.06f, 0.04f, 0.05f));
  for (const double lean : {0.3, 0.8, 1.2}) {
    ContactLoop loop;
    loop.add<FixedBody>(corner, Pose{});
    const dquat turned = glm::angleAxis(0.2, normalize(dvec3(1, 2, 3)));
    auto& body = loop.add<RigidState>(block, Pose{dvec3(0.045, 0.04, 0.0), turned},
                                      test::block_mass(dvec3(0.06, 0.04, 0.05), 0.2));
    loop.set_friction(0.05, 0.05);
    loop.gravity = -kConcaveGravity * dvec3(std::sin(lean), std::cos(lean), 0.0);
    for (int i = 0; i < 480; ++i) loop.step(kConcaveStep);
    for (const ContactPoint& c : loop.contacts)
      EXPECT_TRUE(c.impulse.x == 0.0 || std::max(std::abs(c.normal.x), std::abs(c.normal.y)) > 1 - 1e-6) << lean;
    EXPECT_LT(length(loop.force(1, 0) + 0.2 * loop.gravity), 1e-4) << lean;
    EXPECT_NEAR(body.centre().x, 0.03, 1e-5) << lean;
    EXPECT_NEAR(body.centre().y, 0.02, 1e-5) << lean;
    const dvec3 along = body.rotation() * dvec3(0, 0, 1);
    EXPECT_LT(std::hypot(along.x, along.y), 1e-4) << lean;
  }
}

}  // namespace
}  // namespace pliant
