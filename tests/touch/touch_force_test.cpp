// The force of a touch: the law of the depth, for every law, probe and place, and the same bits every time.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scenes.h"
#include "scenes/touch_laws.h"

namespace pliant {
namespace {

using scenes::Stage;

TEST(Touch, QuasiStaticForceIsTheLawOfTheDepthForEveryLaw) {
  for (const SpringLaw kind : kLaws) {
    Stage stage;
    Deformable d = frictionless(kind);
    d.relaxation_time = 1e-3;  // the arm has long relaxed at this speed
    stage.add(scenes::sheet(40, 0.2), d);
    const Entity probe = stage.add_probe({0.013, 0.002, 0.007});
    stage.prepare();
    stage.move(probe, {0.013, -0.008, 0.007}, 4.0, [&](const ProbeReading& r) {
      if (r.position.y > -1e-4) return;
      ASSERT_TRUE(r.in_contact);
      ASSERT_NEAR(r.depth, -r.position.y, 1e-9);
      // The tissue's memory is sampled at vertices 5 mm apart: an error of some micrometres, of a millinewton where the
      // law has its slope at rest.
      const double sampled = has_arm(kind) ? 1e-3 * restoring_law(d).slope(-r.depth) : 0.0;
      ASSERT_NEAR(r.normal_force, law(d, r.depth), 1e-3 * law(d, r.depth) + sampled) << int(kind);
      // The slope of the tissue's memory is sampled at vertices 5 mm apart: an error of a hundredth of the force.
      const double curved = row_of(kind).step == SpringStep::kPassiveArm ? sampled : 0.0;
      ASSERT_NEAR(r.tangential_force, 0, has_arm(kind) ? 1e-2 * law(d, r.depth) + curved : 1e-9) << int(kind);
    });
  }
}

TEST(Touch, ASofteningLawGivesLessAndLessPerDepthAndNeverLessForMoreDepth) {
  Stage stage;
  Deformable d = frictionless(SpringLaw::kExponential);
  d.stiffening = -60.0;
  stage.add(scenes::sheet(40, 0.2), d);
  const Entity probe = stage.add_probe({0.013, 0.002, 0.007});
  stage.prepare();
  double last = 0.0, deepest = 0.0;
  stage.move(probe, {0.013, -0.02, 0.007}, 4.0, [&](const ProbeReading& r) {
    if (r.position.y > -1e-4) return;
    ASSERT_NEAR(r.normal_force, law(d, r.depth), 1e-3 * law(d, r.depth));
    ASSERT_GE(r.normal_force, last);
    last = r.normal_force;
    deepest = r.depth;
  });
  EXPECT_NEAR(last, d.stiffness / 60 * (1 - std::exp(-60 * deepest)), 1e-3 * last);
  EXPECT_LT(last, 0.6 * d.stiffness * deepest);
}

// A law that leaves the range of numbers is felt as much as a device can render, and lets go where the tip has left.
TEST(Touch, AForceBeyondAllNumbersIsStillAForce) {
  for (const double deepest : {300.0, 400.0, 700.0, 800.0, 5000.0}) {  // alpha d
    Stage stage;
    Deformable d = frictionless(SpringLaw::kExponential);
    d.stiffening = 1e5;
    stage.add(scenes::sheet(40, 0.2), d);
    const Entity probe = stage.add_probe({0.013, 0.002, 0.007});
    stage.prepare();
    const auto check = [&](const ProbeReading& r) {
      const double depth = -r.position.y, force = stage.world.registry.get<Probe>(probe).force.y;
      ASSERT_TRUE(std::isfinite(length(stage.world.registry.get<Probe>(probe).force)));
      if (depth <= 0) ASSERT_EQ(force, 0.0);
    };
    double last = 0.0;
    stage.move(probe, {0.013, -deepest / d.stiffening, 0.007}, 2.0, [&](const ProbeReading& r) {
      check(r);
      const double force = stage.world.registry.get<Probe>(probe).force.y;
      ASSERT_GE(force, last);
      if (r.position.y < 0 && d.stiffening * -r.position.y < 20)
        ASSERT_NEAR(force, law(d, -r.position.y), 1e-3 * force + 1e-12);
      last = force;
    });
    EXPECT_GE(last, 1e8) << deepest;
    stage.move(probe, {0.013, 0.002, 0.007}, 2.0, check);
  }
}

TEST(Touch, StandardLinearSolidRelaxesByItsClosedForm) {
  Stage stage;
  Deformable d = frictionless(SpringLaw::kStandardLinearSolid);
  d.relaxation_stiffness = 450;
  d.relaxation_time = 0.2;
  stage.add(scenes::sheet(40, 0.2), d);
  const Entity probe = stage.add_probe({0, 0, 0});
  stage.prepare();
  stage.tick();
  const double depth = 0.005;
  stage.place(probe, {0, -depth, 0});
  stage.tick();
  // A step of depth within one tick: the arm has relaxed by the mean of e^(-t/tau) over the tick.
  const double T = stage.dt(), tau = d.relaxation_time, E = std::exp(-T / tau);
  for (int n = 0; n < 1000; ++n) {
    const double want = depth * (d.stiffness + d.relaxation_stiffness * (tau / T) * (1 - E) * std::exp(-n * T / tau));
    ASSERT_NEAR(stage.read(probe).normal_force, want, 5e-6) << n;  // the tissue remembers in single precision
    stage.tick();
  }
}

TEST(Touch, ASphereTouchesWithItsLowestPointAndFeelsTheLaw) {
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::sphere(30, 0.1), d);
  const double radius = 0.008;
  const Entity probe = stage.add_probe({0, 0.112, 0}, radius);
  stage.prepare();
  stage.move(probe, {0, 0.104, 0}, 1.0, [&](const ProbeReading& r) {
    const double depth = 0.1 + radius - r.position.y;
    if (std::abs(depth) > 1e-9) ASSERT_EQ(r.in_contact, depth > 0) << depth;
    if (depth > 1e-4) ASSERT_NEAR(r.normal_force, d.stiffness * depth, 0.01 * d.stiffness * depth);
  });
}

TEST(Touch, AProbeFarAwayFeelsNothingOfAnotherOnesContact) {
  Stage stage;
  stage.add(scenes::sheet(40, 0.2), {{.reach = 0.02}});
  const Entity a = stage.add_probe({-0.06, 0.001, 0}), b = stage.add_probe({0.06, 0.001, 0});
  stage.prepare();
  stage.move(a, {-0.06, -0.005, 0}, 0.2, [&](const ProbeReading&) {
    ASSERT_FALSE(stage.read(b).in_contact);
    ASSERT_EQ(stage.read(b).force, dvec3(0));
  });
  EXPECT_TRUE(stage.read(a).in_contact);
}

TEST(Touch, PaintedStiffnessIsFeltWhereItIsPainted) {
  Stage stage;
  Primitive shape = scenes::sheet(40, 0.2);
  for (const vec3& p : shape.position) shape.stiffness.push_back(p.x > 0.02f ? 4.0f : 1.0f);
  const Deformable d = frictionless();
  stage.add(shape, d);
  const Entity soft = stage.add_probe({-0.05, 0.001, 0}), hard = stage.add_probe({0.05, 0.001, 0});
  stage.prepare();
  stage.tick();
  stage.move(soft, {-0.05, -0.002, 0}, 0.1);
  stage.move(hard, {0.05, -0.002, 0}, 0.1);
  EXPECT_NEAR(stage.read(soft).normal_force, 300 * 0.002, 1e-6);
  EXPECT_NEAR(stage.read(hard).normal_force, 1200 * 0.002, 1e-6);
}

TEST(Touch, RetouchingARecoveringSurfaceStartsFromZeroForceAndReachesTheLaw) {
  Stage stage;
  Deformable d = frictionless();
  d.settling_time = 0.4;
  stage.add(scenes::sheet(40, 0.2), d);
  const Entity probe = stage.add_probe({0, 0.001, 0});
  stage.prepare();
  stage.move(probe, {0, -0.008, 0}, 0.2);
  stage.move(probe, {0, 0.004, 0}, 0.01);  // away faster than it recovers
  double before = 0, first = -1;
  stage.move(probe, {0, -0.008, 0}, 0.1, [&](const ProbeReading& r) {
    if (!r.in_contact && r.depth > 0) EXPECT_EQ(r.normal_force, 0) << "inside the rest surface, above the real one";
    if (r.in_contact && first < 0) first = r.depth;
    EXPECT_LT(r.normal_force - before, d.stiffness * 0.012 / 100 * 1.5 + 0.02);  // never a step
    before = r.normal_force;
  });
  EXPECT_GT(first, 5e-4);  // it met the surface below rest
  stage.wait(1.0);
  EXPECT_NEAR(stage.read(probe).normal_force, law(d, 0.008), 2e-3);
}

TEST(Touch, SlidingNeverStepsTheForceByMoreThanTheSlopeTimesTheChangeOfDepth) {
  Stage stage;
  const Deformable d = frictionless();
  stage.add(scenes::sphere(16, 0.1), d);
  const Entity probe = stage.add_probe({0, 0.101, 0});
  stage.prepare();
  dvec3 before(0);
  double depth = 0;
  bool had = false;
  for (int i = 0; i < 3000; ++i) {
    const double a = 1.2 * std::sin(0.002 * i), b = 0.5 * std::cos(0.0011 * i),
                 r = 0.1005 - 0.0055 * std::min(1.0, i / 300.0);
    stage.place(probe, r * normalize(dvec3(std::sin(a), std::cos(a), std::sin(b))));
    stage.tick();
    const ProbeReading x = stage.read(probe);
    if (had && x.in_contact) {
      ASSERT_LE(std::abs(x.normal_force - length(before)), d.stiffness * std::abs(x.depth - depth) * 1.001 + 1e-9) << i;
      ASSERT_LT(length(x.force - before), 0.05) << i;  // the direction turns with the normals, without a jump
    }
    before = x.force, depth = x.depth, had = x.in_contact;
  }
}

TEST(Touch, SameInputGivesTheSameBits) {
  const auto run = [] {
    Stage stage;
    stage.add(scenes::sphere(30, 0.1), {{.reach = 0.03}});
    const Entity a = stage.add_probe({0, 0.11, 0}), b = stage.add_probe({0.11, 0, 0}, 0.005);
    stage.prepare();
    for (int i = 0; i < 500; ++i) {
      stage.place(a, 0.098 * normalize(dvec3(std::sin(0.01 * i), 1, 0.2)) + dvec3(0, 0.01 * std::cos(0.02 * i), 0));
      stage.place(b, 0.1 * normalize(dvec3(1, std::sin(0.01 * i), 0.2)));
      stage.tick();
    }
    return stage.hash();
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace pliant
