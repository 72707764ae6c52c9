// Stacks on a floor: columns, pyramids and drops, of rigid and soft bodies. Nothing sinks in or falls through,
// everything comes to rest, and distant bodies have no effect.
#include <gtest/gtest.h>

#include "systems/soft/body/rigid_state.h"
#include "tests/soft/box_pile.h"
#include "tests/soft/contact_loop.h"

namespace pliant::test {
namespace {

TEST(BoxPile, ABodyThatFallsOnOneAtRestLiesOnIt) {
  for (const bool soft : {false, true}) {
    BoxPile pile;
    for (const double y : {0.5 * kBoxSize, 1.5 * kBoxSize + 0.002}) soft ? pile.cube({0, y, 0}) : pile.rigid({0, y, 0});
    pile.run(2.0);
    EXPECT_GT(pile.lowest(0), -0.01 * kBoxSize) << soft;
    EXPECT_GT(pile.lowest(1), pile.highest(0) - 0.01 * kBoxSize) << soft;
    EXPECT_LT(pile.fastest(), 1e-4) << soft;
  }
}

// Solved to the last digit: this tests which pairs are found. With gaps of 2 mm all fall at once, and each touches the
// one below only because that has been stopped.
TEST(BoxPile, AColumnOfTenBoxesStands) {
  const Mesh ground = test::block_mesh(vec3(1.0f, 0.2f, 1.0f)), box = test::block_mesh(vec3(float(kBoxSize)));
  for (const double turned : {0.0, 0.1}) {
    test::ContactLoop loop;
    loop.margin = {};
    loop.limits = {.sweeps = 20000, .tolerance = 1e-6};
    loop.add<FixedBody>(ground, Pose{dvec3(0, -0.1, 0)});
    std::vector<RigidState*> column;
    for (int i = 0; i < 10; ++i)
      column.push_back(&loop.add<RigidState>(box,
                                             Pose{dvec3(0, 0.5 * kBoxSize + 0.032 * i, 0), turned_about_y(turned * i)},
                                             test::block_mass(dvec3(kBoxSize), 0.027)));
    for (int i = 0; i < 30; ++i) loop.step(kPileStep);
    for (std::size_t i = 0; i < column.size(); ++i) {
      const Vector& v = column[i]->velocity();
      EXPECT_NEAR(column[i]->centre().y, (double(i) + 0.5) * kBoxSize, 0.01 * kBoxSize) << turned << ' ' << i;
      EXPECT_LT(std::hypot(column[i]->centre().x, column[i]->centre().z), 0.01 * kBoxSize) << turned << ' ' << i;
      EXPECT_LT(v.head(3).norm(), 1e-3) << turned << ' ' << i;
    }
  }
}

TEST(BoxPile, ColumnsOfFourSoftCubesStand) {
  BoxPile pile;
  for (int i = 0; i < 4; ++i) pile.cube({0, 0.5 * kBoxSize + 0.032 * i, 0});
  pile.run(2.0);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_GT(pile.lowest(i), (i ? pile.highest(i - 1) : 0.0) - 0.01 * kBoxSize) << i;
  EXPECT_LT(pile.tally().deepest, 0.01 * kBoxSize);
  EXPECT_EQ(pile.tally().began_inside, 0.0);
  EXPECT_LT(pile.fastest(), 1e-4);
}

// With the soft step's own limits, ten seconds long, rotated so that no two boxes' corners are above each other.
TEST(BoxPile, AColumnOfTenBoxesStandsAtTheSoftStepsOwnLimits) {
  for (const double turned : {0.0, 0.05}) {
    BoxPile pile;
    for (int i = 0; i < 10; ++i) pile.rigid({0, 0.5 * kBoxSize + 0.0301 * i, 0}, turned_about_y(turned * i));
    pile.run(10.0);
    for (std::size_t i = 0; i < 10; ++i) {
      EXPECT_NEAR(pile.centre(i).y, (double(i) + 0.5) * kBoxSize, 0.01 * kBoxSize) << turned << ' ' << i;
      EXPECT_LT(std::hypot(pile.centre(i).x, pile.centre(i).z), 0.01 * kBoxSize) << turned << ' ' << i;
    }
    EXPECT_LT(pile.tally().deepest, 0.01 * kBoxSize) << turned;
    EXPECT_LT(pile.fastest(), 1e-4) << turned;
  }
}

TEST(BoxPile, ABlockOfSixtyFourBoxesStands) {
  BoxPile pile;
  for (int i = 0; i < 64; ++i) pile.rigid({0.0302 * (i % 4), 0.5 * kBoxSize + 0.0301 * (i / 16), 0.0302 * (i / 4 % 4)});
  pile.run(3.0);
  for (std::size_t i = 0; i < 64; ++i)
    EXPECT_NEAR(pile.centre(i).y, (double(i / 16) + 0.5) * kBoxSize, 0.003 * kBoxSize) << i;  // 1 % in ten seconds
  EXPECT_LT(pile.tally().deepest, 0.01 * kBoxSize);
  EXPECT_LT(pile.fastest(), 1e-4);
}

// Two cards that lean on each other stand if the floor's friction supports their outward push. The moment of a card's
// weight W about its foot is W (l / 2) sin(a) = N l cos(a), so that N = W tan(a) / 2 <= mu W.
TEST(BoxPile, ACardHouseStandsUpToTheAngleOfFriction) {
  constexpr double kLong = 0.06, kThick = 0.001;  // [m]
  for (const double mu : {0.2, 0.4})
    for (const double share : {0.3, 0.5, 0.8, 0.93, 1.07, 1.2}) {
      SCOPED_TRACE(testing::Message() << "mu " << mu << ", tangent " << share << " of the steepest");
      BoxPile pile;
      const double lean = std::atan(2.0 * mu * share);
      for (const double side : {-1.0, 1.0}) {
        RigidBody card;
        card.friction_static = card.friction_sliding = mu;
        const dquat turned = glm::angleAxis(side * lean, dvec3(0, 0, 1));
        const dvec3 half(0.5 * kThick, 0.5 * kLong, 0.03);
        double low = 1e300, inner = -1e300;
        for (int i = 0; i < 4; ++i) {
          const dvec3 corner = turned * dvec3(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, 0);
          low = std::min(low, corner.y), inner = std::max(inner, -side * corner.x);
        }
        pile.bodies.push_back(pile.stage.add_rigid(scenes::box(2.0 * half), card,
                                                   Pose{dvec3(side * (inner + 1e-5), 1e-5 - low, 0), turned}));
      }
      RigidBody& floor = pile.stage.world.registry.get<RigidBody>(pile.floor);
      floor.friction_static = floor.friction_sliding = mu;
      pile.run(2.0);
      const double upright = kLong * std::cos(lean);
      if (share < 1.0)
        EXPECT_NEAR(pile.highest(0), upright, 0.02 * kLong);
      else
        EXPECT_LT(pile.highest(0), 0.5 * upright) << "it has slid apart";
      EXPECT_LT(pile.tally().deepest, 0.5 * kThick);
    }
}

TEST(BoxPile, APyramidOfBoxesStands) {
  BoxPile pile;
  for (int row = 0; row < 4; ++row)
    for (int i = 0; i < 4 - row; ++i) pile.rigid({0.032 * (i - 0.5 * (3 - row)), 0.5 * kBoxSize + 0.0301 * row, 0});
  pile.run(3.0);
  std::size_t body = 0;
  for (int row = 0; row < 4; ++row)
    for (int i = 0; i < 4 - row; ++i, ++body)
      EXPECT_NEAR(pile.centre(body).y, kBoxSize * (row + 0.5), 0.01 * kBoxSize) << row << ' ' << i;
  EXPECT_LT(pile.fastest(), 1e-3);
}

TEST(BoxPile, SixtyFourBoxesOnOneFloorAllStayOnIt) {
  BoxPile pile;
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 8; ++k) pile.rigid({0.04 * (i - 3.5), 0.02, 0.04 * (k - 3.5)});
  pile.run(1.0);
  for (std::size_t i = 0; i < pile.bodies.size(); ++i) EXPECT_NEAR(pile.lowest(i), 0.0, 0.01 * kBoxSize) << i;
  EXPECT_LT(pile.fastest(), 1e-3);
}

// Twenty in a tray of four walls: boxes, plates, soft cubes and balls.
TEST(BoxPile, WhatIsDroppedIntoATrayStaysInItAndComesToRest) {
  BoxPile pile;
  for (const double side : {-1.0, 1.0}) {
    pile.wall(dvec3(0.02, 0.2, 0.2), dvec3(0.08 * side, 0.1, 0));
    pile.wall(dvec3(0.2, 0.2, 0.02), dvec3(0, 0.1, 0.08 * side));
  }
  for (int i = 0; i < 20; ++i) {
    const dvec3 r = tets::scatter(static_cast<std::uint32_t>(i));
    const dvec3 at(0.045 * (i % 2 ? 1 : -1) * (i % 4 < 2 ? 1 : 0.8), 0.04 + 0.045 * (i / 4),
                   0.045 * (i % 4 < 2 ? 1 : -1) + 0.002 * r.z);
    const dquat turned = glm::angleAxis(r.x, normalize(dvec3(1, 2, 3) + r));
    if (i % 5 == 0)
      pile.cube(at, turned, 2);
    else if (i % 5 == 1)
      pile.ball(at);
    else if (i % 5 == 2)
      pile.rigid(at, turned, dvec3(kBoxSize, 0.006, kBoxSize));
    else
      pile.rigid(at, turned);
  }
  pile.run(2.5);
  for (std::size_t i = 0; i < pile.bodies.size(); ++i) {
    const dvec3 c = pile.centre(i);
    EXPECT_GT(pile.lowest(i), -0.01 * kBoxSize) << i;
    EXPECT_LT(std::max(std::abs(c.x), std::abs(c.z)), 0.07) << i;
  }
  double depth = 0.0;
  for (const ContactPoint& contact : pile.stage.soft().contacts) depth = std::max(depth, contact.depth);
  EXPECT_LT(depth, 0.01 * kBoxSize);
  EXPECT_LT(pile.fastest(), 2e-2);
}

// Wedged between each other and the walls, they cannot all be pushed out of each other. Only 27: 64 rest as well.
TEST(BoxPile, BoxesAtRandomInABinRestWithSolutionsThatConverge) {
  BoxPile pile;
  for (const double side : {-1.0, 1.0}) {
    pile.wall(dvec3(0.02, 0.4, 0.2), dvec3(0.085 * side, 0.2, 0));
    pile.wall(dvec3(0.2, 0.4, 0.02), dvec3(0, 0.2, 0.085 * side));
  }
  for (int i = 0; i < 27; ++i) {
    const dvec3 r = tets::scatter(static_cast<std::uint32_t>(i));
    pile.rigid({0.047 * (i % 3 - 1), 0.04 + 0.062 * (i / 9), 0.047 * (i / 3 % 3 - 1)},
               glm::angleAxis(M_PI * r.x, normalize(r)));
  }
  const auto energy = [&] {  // [J]
    double sum = 0.0;
    for (const Entity e : pile.bodies) {
      const RigidState& box = *pile.stage.body(e).as_rigid();
      sum += box.kinetic_energy() + box.mass().mass * 9.81 * box.centre().y;
    }
    return sum;
  };
  pile.run(50 * kPileStep);
  const std::uint64_t in_falling = pile.tally().unconverged;
  double before = energy();
  for (int i = 0; i < 40; ++i) {
    pile.stage.step();
    const double now = energy();
    EXPECT_LT(now, before + 1e-8) << "[J] in step " << i;
    before = now;
  }
  EXPECT_EQ(pile.tally().unconverged, in_falling);
  EXPECT_LT(pile.fastest(), 1e-4);
  for (std::size_t i = 0; i < pile.bodies.size(); ++i) EXPECT_GT(pile.lowest(i), -0.02 * kBoxSize) << i;
}

// A soft block dragged over the floor by its weight, with and without a pebble at rest half a metre away.
TEST(BoxPile, APebbleElsewhereChangesNothing) {
  const auto slide = [](bool pebble) {
    BoxPile pile;
    pile.cube({0, 0.5 * kBoxSize + 1e-4, 0}, turned_about_y(0.3), 4);
    pile.rigid({0, 1.5 * kBoxSize + 2e-4, 0});
    if (pebble) pile.rigid({0.4, 0.0005, 0.4}, kUpright, dvec3(0.001));
    pile.stage.world.simulation.gravity = dvec3(6, -9.81, 0);
    pile.run(0.5);
    return pile.collision_mesh(0);
  };
  const std::vector<dvec3> alone = slide(false), with = slide(true);
  EXPECT_GT(alone[0].x, 0.05) << "it should slide";
  double apart = 0.0;
  for (std::size_t v = 0; v < alone.size(); ++v) apart = std::max(apart, length(alone[v] - with[v]));
  EXPECT_LT(apart, 1e-6 * alone[0].x);
}

// Two bodies with an initial overlap of `depth`, without gravity; body 1 must leave body 0 along `way`.
struct Overlap {
  dvec3 size_a, size_b, at;
  double depth;
  dvec3 way;
};
// Crossing bars and plates have no vertex inside each other, aligned boxes share all their side planes, one body is
// inside the other.
TEST(BoxPile, WhatBeginsInsideIsPushedOutTheShortestWay) {
  const std::vector<Overlap> cases{
      {dvec3(kBoxSize), dvec3(kBoxSize), dvec3(0, 0.02, 0), 0.01, dvec3(0, 1, 0)},
      {dvec3(kBoxSize), dvec3(kBoxSize), dvec3(0), kBoxSize, dvec3(0)},
      {dvec3(0.1, 0.02, 0.02), dvec3(0.02, 0.02, 0.1), dvec3(0, 0.015, 0), 0.005, dvec3(0, 1, 0)},
      {dvec3(0.1, 0.002, 0.1), dvec3(0.002, 0.1, 0.1), dvec3(0, 0.045, 0), 0.006, dvec3(0, 1, 0)},
      {dvec3(0.1), dvec3(0.02), dvec3(0.02, 0.03, 0.01), 0.03, dvec3(0, 1, 0)},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Overlap& c = cases[i];
    BoxPile pile;
    pile.stage.world.simulation.gravity = dvec3(0);
    pile.rigid({0, 0.5, 0}, kUpright, c.size_a);
    pile.rigid(dvec3(0, 0.5, 0) + c.at, kUpright, c.size_b);
    pile.run(kPileStep);
    EXPECT_NEAR(pile.tally().deepest, c.depth, 1e-6) << i;
    EXPECT_EQ(pile.tally().began_inside, pile.tally().deepest) << i;
    const double limit = kPenetrationShare * c.depth / kPileStep;  // [m/s] that contacts ask for at most
    for (int step = 0; step < 60; ++step) {
      pile.stage.step();
      EXPECT_LT(pile.fastest(), 1.1 * limit) << i << ' ' << step;
    }
    const dvec3 way = pile.centre(1) - pile.centre(0), apart = glm::abs(way) - 0.5 * (c.size_a + c.size_b);
    EXPECT_GT(std::max({apart.x, apart.y, apart.z}), -1e-6) << i;
    EXPECT_LT(length(way - c.at - dot(way - c.at, c.way) * c.way), c.way == dvec3(0) ? 1.0 : 1e-2) << i;
  }
}

}  // namespace
}  // namespace pliant::test
