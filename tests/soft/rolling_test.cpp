// Balls that roll on a plane without slip, against closed forms: on the level they keep their speed, on an incline they
// gain g sin(angle) / (1 + I / m r^2) per second. Soft blocks on an incline, which static friction holds up to its
// angle. Heavy bodies on light ones.
#include <gtest/gtest.h>

#include "tests/content/mesh_shapes.h"
#include "tests/soft/box_pile.h"

namespace pliant::test {
namespace {

struct Rolling {
  double radius = 0.03, speed = 0.0, slope = 0.0, step = kPileStep;  // [m], [m/s], [rad], [s]
  int levels = 3;                                                    // of the icosphere
};
struct Rolled {
  double speed = 0.0, expected = 0.0, slip = 0.0;  // [m/s] at the end
  double highest = 0.0, lowest = 1e300;            // [m] of the centre over the plane, less the radius
};

Rolled roll(const Rolling& r, double seconds) {
  scenes::ToolStage stage(r.step);
  RigidBody rough;
  rough.friction_static = rough.friction_sliding = 0.8;
  RigidBody plane = rough;
  plane.fixed = true;
  stage.add_rigid(scenes::box(dvec3(20, 0.1, 20), dvec3(0, -0.05, 0)), plane, {});
  Primitive sphere = icosphere(r.levels);
  for (vec3& x : sphere.position) x *= float(r.radius);
  const Entity entity = stage.add_rigid(sphere, rough, Pose{dvec3(0, r.radius, 0), kUpright});
  stage.world.simulation.gravity = 9.81 * dvec3(std::sin(r.slope), -std::cos(r.slope), 0);
  stage.prepare();
  auto& ball = dynamic_cast<RigidState&>(stage.body(entity));
  ball.set_velocity(dvec3(r.speed, 0, 0), dvec3(0, 0, -r.speed / r.radius));
  Rolled out;
  for (int i = 0; i < int(std::lround(seconds / r.step)); ++i) {
    stage.step();
    out.highest = std::max(out.highest, ball.centre().y - r.radius);
    out.lowest = std::min(out.lowest, ball.centre().y - r.radius);
  }
  const double inertia = ball.mass().inertia[2][2] / (ball.mass().mass * r.radius * r.radius);
  out.speed = ball.velocity()[0];
  out.expected = r.speed + 9.81 * std::sin(r.slope) / (1.0 + inertia) * seconds;
  out.slip = ball.velocity()[0] + ball.velocity()[5] * r.radius;
  return out;
}

TEST(RollingBall, KeepsItsSpeedOnTheLevel) {
  for (const double step : {kPileStep, 1.0 / 240.0})
    for (const double radius : {0.01, 0.03, 0.1})
      for (const double speed : {0.1, 0.42, 2.0}) {
        SCOPED_TRACE(testing::Message() << "step " << step << ", radius " << radius << ", speed " << speed);
        const Rolled r = roll({.radius = radius, .speed = speed, .step = step}, 1.0);
        EXPECT_NEAR(r.speed, speed, 0.05 * speed);
        EXPECT_NEAR(r.slip, 0.0, 0.02 * speed);
        EXPECT_LT(r.highest, 0.01 * radius) << "it floats";
        EXPECT_GT(r.lowest, -0.01 * radius) << "it sinks in";
      }
}

TEST(RollingBall, GainsFiveSeventhsOfGravityOnAnIncline) {
  for (const double step : {kPileStep, 1e-3})
    for (const double degrees : {5.0, 20.0, 35.0}) {
      SCOPED_TRACE(testing::Message() << "step " << step << ", incline " << degrees);
      const Rolled r = roll({.slope = degrees * M_PI / 180.0, .step = step}, 1.4);
      EXPECT_NEAR(r.speed, r.expected, 0.05 * r.expected);
      EXPECT_NEAR(r.slip, 0.0, 0.02 * r.speed);
    }
}

// It tips over the edge: no contact lies on a side face beyond its rim.
TEST(RollingBall, FallsOverAnEdgeWithoutGainingEnergy) {
  for (const double step : {kPileStep, 1.0 / 240.0})
    for (const dvec3 speed : {dvec3(0.144, 0, 0.144), dvec3(0.072, 0, 0.072), dvec3(0.216, 0, 0)}) {
      SCOPED_TRACE(testing::Message() << "step " << step << ", speed " << speed.x);
      scenes::ToolStage stage(step);
      RigidBody rough;
      rough.friction_static = rough.friction_sliding = 0.8;
      RigidBody plate = rough;
      plate.fixed = true;
      stage.add_rigid(scenes::box(dvec3(0.4, 0.02, 0.4), dvec3(0, -0.01, 0)), plate, {});
      constexpr double kRadius = 0.025;
      Primitive sphere = icosphere(2);
      for (vec3& x : sphere.position) x *= float(kRadius);
      const Entity entity = stage.add_rigid(sphere, rough, Pose{dvec3(0.15, kRadius, 0), kUpright});
      stage.world.simulation.gravity = dvec3(0, -9.81, 0);
      stage.prepare();
      auto& ball = dynamic_cast<RigidState&>(stage.body(entity));
      ball.set_velocity(speed, dvec3(speed.z, 0, -speed.x) / kRadius);
      const auto energy = [&] {
        const Vector v = ball.velocity();
        const double inertia = ball.mass().inertia[2][2] / ball.mass().mass;
        return 9.81 * ball.centre().y + 0.5 * v.head<3>().squaredNorm() + 0.5 * inertia * v.tail<3>().squaredNorm();
      };
      const double begin = energy();
      for (int i = 0; i < int(std::lround(1.2 / step)); ++i) {
        stage.step();
        ASSERT_LT(energy(), 1.02 * begin) << "at x = " << ball.centre().x;
      }
      EXPECT_LT(ball.centre().y, 0.0) << "it has fallen";
    }
}

// [m] that a block slides down in a second, once the plane has been raised to this slope.
double slid(double young, double mu_static, double mu_sliding, double slope) {
  scenes::ToolStage stage(kPileStep);
  RigidBody plane = fixed();
  plane.friction_static = mu_static, plane.friction_sliding = mu_sliding;
  stage.add_rigid(scenes::box(dvec3(20, 0.1, 20), dvec3(0, -0.05, 0)), plane, {});
  SoftBody block = pile_rubber();
  block.young = young;
  block.friction_static = mu_static, block.friction_sliding = mu_sliding;
  const TetMesh tets = tets::box(4, 4, 4, dvec3(-0.5 * kBoxSize), dvec3(0.5 * kBoxSize));
  const Entity entity = stage.add_soft(tets, block, Pose{dvec3(0, 0.5 * kBoxSize + 1e-5, 0), kUpright});
  stage.prepare();
  const auto run = [&](double seconds, double from, double to) {
    const int steps = int(std::lround(seconds / kPileStep));
    for (int i = 1; i <= steps; ++i) {
      const double angle = from + (to - from) * i / steps;
      stage.world.simulation.gravity = 9.81 * dvec3(std::sin(angle), -std::cos(angle), 0);
      stage.step();
    }
  };
  const auto place = [&] {
    double x = 0.0;
    for (const dvec3& v : stage.body(entity).surface_position) x += v.x;
    return x / double(stage.body(entity).surface_position.size());
  };
  run(0.5, 0.0, 0.0), run(1.0, 0.0, slope), run(0.3, slope, slope);
  const double before = place();
  run(1.0, slope, slope);
  return place() - before;
}

TEST(SoftBlock, SlidesDownIfTheSlopeIsSteeperThanStaticFriction) {
  for (const double young : {2e4, 1e6})
    for (const double mu : {0.6, 0.4}) {
      SCOPED_TRACE(testing::Message() << "E " << young << ", mu " << mu);
      EXPECT_LT(slid(young, mu, 0.5 * mu, std::atan(0.95 * mu)), 1e-5);
      const double steep = std::atan(1.05 * mu);  // then friction is the sliding one
      const double gained = 9.81 * (std::sin(steep) - 0.5 * mu * std::cos(steep));
      EXPECT_GT(slid(young, mu, 0.5 * mu, steep), 0.5 * gained);
    }
}

// A box of 3 or 10 kg on one of 1 g, beside its middle and turned; with the sweeps of lighter columns it fell over.
TEST(HeavyOnLight, AColumnStands) {
  struct Case {
    double heavy, beside, turned;  // [kg], [m], [rad]
  };
  for (const Case& c : {Case{3.0, 0.002, 0.3}, Case{10.0, 0.0, 0.3}, Case{10.0, 0.005, 0.0}}) {
    SCOPED_TRACE(testing::Message() << "1 g under " << c.heavy << " kg, " << c.beside << " m beside, " << c.turned);
    BoxPile pile;
    RigidBody light, heavy;
    light.mass = 1e-3, heavy.mass = c.heavy;
    const dvec3 at(c.beside, 1.5 * kBoxSize + 2e-4, 0.5 * c.beside);
    pile.bodies.push_back(
        pile.stage.add_rigid(scenes::box(dvec3(kBoxSize)), light, Pose{dvec3(0, 0.5 * kBoxSize + 1e-4, 0), kUpright}));
    pile.bodies.push_back(
        pile.stage.add_rigid(scenes::box(dvec3(kBoxSize)), heavy, Pose{at, turned_about_y(c.turned)}));
    pile.run(3.0);
    EXPECT_NEAR(pile.centre(0).y, 0.5 * kBoxSize, 0.01 * kBoxSize);
    EXPECT_NEAR(pile.centre(1).y, 1.5 * kBoxSize, 0.01 * kBoxSize);
    EXPECT_LT(std::hypot(pile.centre(1).x - at.x, pile.centre(1).z - at.z), 0.01 * kBoxSize);
    EXPECT_LT(pile.fastest(), 1e-4);
  }
}

}  // namespace
}  // namespace pliant::test
