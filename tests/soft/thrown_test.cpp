// Soft bodies that are thrown or squeezed: nothing passes through, and they stay still afterwards.
#include <gtest/gtest.h>

#include "tests/soft/box_pile.h"
#include "tests/soft/contact_loop.h"

namespace pliant::test {
namespace {

// [1] Winding number of a collision mesh at a point, by solid angles (Van Oosterom & Strackee 1983).
double winding(const Body& body, dvec3 p) {
  double angle = 0.0;
  for (const uvec3& t : body.collision_mesh->triangles) {
    const dvec3 a = body.surface_position[t.x] - p, b = body.surface_position[t.y] - p,
                c = body.surface_position[t.z] - p;
    const double la = length(a), lb = length(b), lc = length(c);
    angle += 2.0 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return angle / (4.0 * M_PI);
}

// Sets a soft body in motion as a whole; it is a step further then.
void throw_down(BoxPile& pile, std::size_t body, double speed) {
  SoftBodyState& tissue = pile.stage.tissue(pile.bodies[body]);
  tissue.free_step(kPileStep, dvec3(0, -speed / kPileStep, 0));
  tissue.advance(kPileStep);
}

// At 3 m/s a body moves 50 mm in a step.
TEST(BoxPile, SoftBodiesThrownAtAFloorOrAThinBarDoNotPass) {
  for (const bool bar : {false, true})
    for (const int kind : {0, 1, 2})
      for (const double turned : {0.0, 0.5}) {
        BoxPile pile;
        pile.stage.world.simulation.gravity = dvec3(0);
        const Pose pose{dvec3(0, 0.115, 0), glm::angleAxis(turned, normalize(dvec3(1, 2, 3)))};
        const dvec3 half = kind == 0 ? dvec3(0.5 * kBoxSize) : dvec3(0.5 * kBoxSize, 0.0015, 0.5 * kBoxSize);
        pile.bodies.push_back(pile.stage.add_soft(
            kind == 2 ? soft_ball(0.5 * kBoxSize) : tets::box(4, 4, 4, -half, half), pile_rubber(), pose));
        if (bar) pile.wall(dvec3(0.2, 0.004, 0.004), dvec3(0, 0.02, 0.003));
        pile.stage.prepare();
        throw_down(pile, 0, 3.0);
        SCOPED_TRACE(testing::Message() << "bar " << bar << ", kind " << kind << ", turned " << turned);
        for (int step = 0; step < 40; ++step) {
          pile.stage.step();
          ASSERT_GT(pile.lowest(0), -0.01 * kBoxSize) << step;
          for (double x = -0.06; bar && x < 0.06; x += 0.002)
            ASSERT_LT(std::abs(winding(pile.stage.body(pile.bodies[0]), dvec3(x, 0.02, 0.003))), 0.5) << step;
        }
        EXPECT_EQ(pile.tally().halted, 0u);
      }
}

TEST(BoxPile, SoftBodiesThrownAtEachOtherDoNotPass) {
  for (const bool balls : {false, true}) {
    BoxPile pile;
    pile.stage.world.simulation.gravity = dvec3(0);
    for (const double y : {0.3, 0.45}) balls ? pile.ball({0.004 * y, y, 0}) : pile.cube({0.004 * y, y, 0});
    pile.stage.prepare();
    throw_down(pile, 0, -1.5), throw_down(pile, 1, 1.5);
    for (int step = 0; step < 30; ++step) {
      pile.stage.step();
      ASSERT_GT(pile.centre(1).y, pile.centre(0).y) << balls << ' ' << step;
      for (const int i : {0, 1})
        for (const dvec3& x : pile.collision_mesh(static_cast<std::size_t>(i))) {
          const dvec3 inwards = x + 0.02 * kBoxSize * normalize(x - pile.centre(static_cast<std::size_t>(1 - i)));
          ASSERT_LT(winding(pile.stage.body(pile.bodies[static_cast<std::size_t>(1 - i)]), inwards), 0.5) << step;
        }
    }
  }
}

// Squashed to 15 % of its height under a plate: thinned contacts alone let it sink 4 mm into the floor.
TEST(BoxPile, ASquashedBlockIsHeldByTheFloorAndStill) {
  BoxPile pile;
  pile.cube({0, 0.5 * kBoxSize, 0}, kUpright, 6);
  const Entity plate = pile.wall(dvec3(0.1, 0.01, 0.1), dvec3(0, kBoxSize + 0.0055, 0));
  pile.stage.prepare();
  auto& driven = dynamic_cast<FixedBody&>(pile.stage.body(plate));
  double least = 1e300, most = 0.0;
  for (int step = 0; step < 150; ++step) {
    driven.set_velocity(dvec3(0, step < 60 ? -(0.85 * kBoxSize + 0.0005) : 0.0, 0), dvec3(0));
    pile.stage.step();
    EXPECT_GT(pile.lowest(0), -0.01 * kBoxSize) << step;
    if (step < 130) continue;
    const double force = pile.stage.contact_force(pile.bodies[0], pile.floor).y;
    least = std::min(least, force), most = std::max(most, force);
  }
  EXPECT_GT(least, 10.0);
  EXPECT_LT(most - least, 1e-4 * most);
}

// A ring of rubber that is open at its top, squeezed from both sides until its ends have met.
TEST(BoxPile, TheEndsOfASqueezedRingMeetAndDoNotPassThroughEachOther) {
  BoxPile pile;
  pile.stage.world.simulation.gravity = dvec3(0);
  TetMesh ring = tets::box(36, 2, 4, dvec3(0, -0.002, -0.0075), dvec3(1, 0.002, 0.0075));
  std::vector<std::size_t> first, last;
  for (std::size_t n = 0; n < ring.nodes.size(); ++n) {
    dvec3& x = ring.nodes[n];
    if (x.x < 1e-9) first.push_back(n);
    if (x.x > 1.0 - 1e-9) last.push_back(n);
    const double angle = 0.5 * M_PI - 0.3 - x.x * (2.0 * M_PI - 0.6), r = 0.02 + x.y;
    x = dvec3(r * std::cos(angle), 0.5 + r * std::sin(angle), x.z);
  }
  SoftBody body = pile_rubber();
  body.young = 1e5;
  pile.bodies.push_back(pile.stage.add_soft(ring, body, {}));
  std::array<Entity, 2> jaws;
  for (const int i : {0, 1}) jaws[i] = pile.wall(dvec3(0.01, 0.06, 0.05), dvec3(0.0275 * (i ? 1 : -1), 0.5, 0));
  pile.stage.prepare();
  double pressed = 0.0;
  for (int step = 0; step < 90; ++step) {
    for (const int i : {0, 1})
      dynamic_cast<FixedBody&>(pile.stage.body(jaws[i]))
          .set_velocity(dvec3(step < 60 ? 0.01 * (i ? -1 : 1) : 0.0, 0, 0), dvec3(0));
    pile.stage.step();
    for (const ContactPoint& c : pile.stage.soft().contacts)
      if (c.body_a == c.body_b) pressed += c.impulse.x;
  }
  EXPECT_GT(pressed, 0.0);
  const std::vector<dvec3>& now = pile.stage.tissue(pile.bodies[0]).tissue().position();
  dvec3 of_first(0), of_last(0);
  for (const std::size_t n : first) of_first += now[n] / double(first.size());
  for (const std::size_t n : last) of_last += now[n] / double(last.size());
  EXPECT_GT(of_first.x - of_last.x, 0.0);
}

}  // namespace
}  // namespace pliant::test
