// A sheet is a fixed surface with a single layer that encloses nothing. Its front stops falling objects; from behind,
// objects pass freely.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/soft/collision_shapes.h"
#include "tests/soft/contact_loop.h"

namespace pliant {
namespace {

using test::ContactLoop;
constexpr double kSheetStep = 1.0 / 60.0;  // [s]
constexpr double kSheetGravity = 9.81;     // [m/s2]
constexpr double kSheetMass = 0.05;        // [kg]

float flat(float, float) {
  return 0.0f;
}
float hilly(float x, float z) {
  return 0.004f * std::sin(60.0f * x) * std::cos(45.0f * z);
}

// A ball or a block near a sheet of 0.2 m about the origin, faces up.
struct Flight {
  const bool round;
  Mesh sheet, thing;
  ContactLoop loop;
  RigidState* body;
  Flight(Mesh surface, bool ball, dvec3 at, dquat attitude, dvec3 velocity, dvec3 spin)
      : round(ball),
        sheet(std::move(surface)),
        thing(round ? test::sphere_mesh(0.02f, 3) : test::block_mesh(vec3(0.03f))) {
    loop.add<FixedBody>(sheet, Pose{});
    body =
        &loop.add<RigidState>(thing, Pose{at, attitude},
                              round ? test::sphere_mass(0.02, kSheetMass) : test::block_mass(dvec3(0.03), kSheetMass));
    body->set_velocity(velocity, spin);
    loop.set_friction(0.5, 0.4);
  }
  dvec3 velocity() const { return {body->velocity()[0], body->velocity()[1], body->velocity()[2]}; }
  dvec3 spin() const { return {body->velocity()[3], body->velocity()[4], body->velocity()[5]}; }
  dvec3 force() const { return loop.force(1, 0); }  // [N] on the body
  double lowest() const {
    double y = 1.0;
    for (const dvec3& x : body->surface_position) y = std::min(y, x.y);
    return y;
  }
};

struct SheetDice {
  std::mt19937 random;
  double operator()(double most) { return std::uniform_real_distribution<double>(-most, most)(random); }
  dvec3 vector(double most) { return {(*this)(most), (*this)(most), (*this)(most)}; }
  dquat attitude() { return glm::angleAxis((*this)(3.0), normalize(vector(1.0))); }
};

TEST(SheetContact, WhatIsThrownOnTheFrontRestsOnItHoweverCoarseTheSheet) {
  for (const bool round : {true, false})
    for (const int squares : {1, 16})
      for (const double speed : {0.1, 1.0})
        for (std::uint32_t seed = 0; seed < 6; ++seed) {
          SheetDice dice{std::mt19937(seed)};
          Flight flight(test::relief_mesh(0.2f, squares, 0.0f, true, flat), round, dvec3(dice(0.04), 0.035, dice(0.04)),
                        dice.attitude(), dvec3(dice(0.1), -speed, dice(0.1)), dice.vector(4.0));
          double worst = 0;
          for (int i = 0; i < 180; ++i) {
            flight.loop.step(kSheetStep);
            worst = std::max(worst, -flight.lowest());
          }
          SCOPED_TRACE(testing::Message()
                       << "round " << round << ", " << squares << " squares, " << speed << " m/s, " << seed);
          // Rotation while it is stopped: (4 rad/s / 60)^2 / 2 of its radius at least.
          EXPECT_LT(worst, 6e-4);
          EXPECT_LT(std::abs(flight.lowest()), 2e-6);
          EXPECT_NEAR(flight.force().y, kSheetMass * kSheetGravity, 0.01 * kSheetMass * kSheetGravity);
        }
}

TEST(SheetContact, WhatIsThrownOnHillsStaysOnThem) {
  for (const bool round : {true, false})
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
      SheetDice dice{std::mt19937(seed)};
      Flight flight(test::relief_mesh(0.2f, 24, 0.0f, true, hilly), round, dvec3(dice(0.04), 0.035, dice(0.04)),
                    dice.attitude(), dvec3(dice(0.1), -1.0, dice(0.1)), dice.vector(4.0));
      for (int i = 0; i < 180; ++i) {
        flight.loop.step(kSheetStep);
        EXPECT_GT(flight.lowest(), -0.0045) << "round " << round << ", " << seed << ", step " << i;
      }
      EXPECT_LT(length(flight.force() - dvec3(0, kSheetMass * kSheetGravity, 0)), 1e-3 * kSheetMass * kSheetGravity)
          << seed;
    }
}

TEST(SheetContact, WhatComesFromBehindPassesUnhindered) {
  for (const bool round : {true, false})
    for (const int squares : {1, 16})
      for (const double speed : {0.02, 1.0})
        for (std::uint32_t seed = 0; seed < 8; ++seed) {
          SheetDice dice{std::mt19937(seed)};
          const dvec3 velocity(seed % 2 * dice(0.3 * speed), speed, seed % 2 * dice(0.3 * speed));
          // Half of them through the border.
          const double aside = seed < 4 ? 0.0 : 0.1;
          Flight flight(test::relief_mesh(0.2f, squares, 0.0f, true, flat), round,
                        dvec3(aside + dice(0.02), -0.035, dice(0.04)), seed ? dice.attitude() : dquat(1, 0, 0, 0),
                        velocity, dvec3(0));
          flight.loop.gravity = dvec3(0);
          for (int i = 0; i < int(0.08 / speed / kSheetStep); ++i) flight.loop.step(kSheetStep);
          SCOPED_TRACE(testing::Message()
                       << "round " << round << ", " << squares << " squares, " << speed << " m/s, " << seed);
          EXPECT_GT(flight.body->centre().y, 0.03);
          EXPECT_LT(length(flight.velocity() - velocity), 1e-9 * speed);
          EXPECT_LT(length(flight.spin()) * 0.02, 1e-9 * speed);
        }
}

TEST(SheetContact, WhatPassedFromBehindFallsBackOnTheFrontAndRests) {
  for (const bool round : {true, false}) {
    Flight flight(test::relief_mesh(0.2f, 16, 0.0f, true, flat), round, dvec3(0.01, -0.04, 0.0),
                  glm::angleAxis(0.3, normalize(dvec3(1, 2, 3))), dvec3(0, 1.5, 0), dvec3(0));
    double highest = 0;
    for (int i = 0; i < 240; ++i) {
      flight.loop.step(kSheetStep);
      highest = std::max(highest, flight.lowest());
    }
    EXPECT_GT(highest, 0.02) << "it should have passed";
    EXPECT_LT(std::abs(flight.lowest()), 2e-6);
    EXPECT_NEAR(flight.force().y, kSheetMass * kSheetGravity, 0.01 * kSheetMass * kSheetGravity);
  }
}

TEST(SheetContact, WhatIsPutIntoASheetByAHairIsLiftedOntoIt) {
  Flight flight(test::relief_mesh(0.2f, 16, 0.0f, true, flat), false, dvec3(0.003, 0.015 - 5e-4, 0.001),
                dquat(1, 0, 0, 0), dvec3(0), dvec3(0));
  for (int i = 0; i < 120; ++i) flight.loop.step(kSheetStep);
  EXPECT_NEAR(flight.lowest(), 0.0, 1e-6);
  EXPECT_NEAR(flight.force().y, kSheetMass * kSheetGravity, 1e-3 * kSheetMass * kSheetGravity);
}

}  // namespace
}  // namespace pliant
