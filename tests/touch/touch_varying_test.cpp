// Surfaces whose parameters an animation varies: the law of the moment, and no energy beyond what the rise of stiffness
// makes, which is booked.
#include <gtest/gtest.h>

#include <cmath>

#include "components/varying.h"
#include "scenes/count_allocations.h"
#include "scenes/scenes.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

using scenes::Stage;

Track keys(std::vector<double> times, const std::vector<double>& values,
           Interpolation interpolation = Interpolation::kLinear) {
  Track track;
  track.interpolation = interpolation;
  track.length = times.back();
  track.times = std::move(times);
  for (const double value : values) track.values.emplace_back(value, 0.0, 0.0, 0.0);
  return track;
}

struct Varied : Stage {
  explicit Varied(Varying varying, Deformable deformable = smooth()) {
    vary(varying, 0.0, deformable);
    plate = add(scenes::sheet(30, 0.1), deformable);
    world.registry.add(plate, std::move(varying));
    finger = add_probe({0.001, 0.002, 0.002});
    prepare();
  }
  static Deformable smooth() {
    Deformable deformable;
    deformable.friction_static = deformable.friction_sliding = 0.0;
    deformable.reach = 0.02;
    return deformable;
  }
  double sent() { return device(finger).force_sent.y; }
  ProbeState& hand() { return world.touch->probes[0]; }
  std::uint64_t withheld() { return hand().safety.tally.of(SafetyLimit::kWithheld).ticks; }
  // Moves, and adds up the work of what is sent.
  void go(double y, double seconds) {
    move(finger, {0.001, y, 0.002}, seconds, [&](ProbeReading reading) {
      reading.force = device(finger).force_sent;
      meter.add(reading);
      const double k = world.registry.get<Deformable>(plate).stiffness;
      off = std::max(off, std::abs(reading.force.y - k * std::max(0.0, -reading.position.y)));
    });
  }
  void hold(double seconds) { go(device(finger).position.y, seconds); }

  Entity plate, finger;
  scenes::WorkMeter meter;
  double off = 0.0;  // [N] largest difference from the law of the moment
};

Varying stiffness(const Track& track, bool repeats = false) {
  Varying varying;
  varying.repeats = repeats;
  varying.tracks.push_back({&DeformableParameters::stiffness, DeformableRange::kStiffness, track});
  return varying;
}

TEST(Varying, AKeyIsClampedToItsRangeAndSlidingFrictionToStatic) {
  Varying varying = stiffness(keys({0.0, 1.0}, {300.0, -500.0}));
  varying.tracks.push_back({&DeformableParameters::friction_static, {0.0, 10.0}, keys({0.0, 1.0}, {0.5, 0.1})});
  DeformableParameters now;
  vary(varying, 0.5, now);
  EXPECT_EQ(now.stiffness, DeformableRange::kStiffness.min);
  EXPECT_DOUBLE_EQ(now.friction_static, 0.3);
  EXPECT_DOUBLE_EQ(now.friction_sliding, 0.3);
  vary(varying, 9.0, now);
  EXPECT_DOUBLE_EQ(now.friction_sliding, 0.1);
}

// 1/2 dk d^2, which no hand has given, comes back to the hand as it lifts.
TEST(Varying, ARisingStiffnessPushesTheHandWithWhatItGained) {
  Varied at(stiffness(keys({0.3, 0.8}, {300.0, 900.0})));
  at.go(-0.003, 0.2);
  at.hold(0.8);
  EXPECT_NEAR(at.sent(), 900.0 * 0.003, 1e-9);
  at.go(0.002, 0.3);
  const double gained = 0.5 * 600.0 * 0.003 * 0.003;
  EXPECT_LT(at.off, 1e-9) << "the law of the moment, at every tick";
  EXPECT_EQ(at.withheld(), 0u);
  EXPECT_NEAR(at.hand().stiffened_sum, gained, 1e-12);
  EXPECT_NEAR(at.meter.work(), gained, 0.01 * gained);
}

TEST(Varying, AStepOfStiffnessIsBookedToo) {
  Varied at(stiffness(keys({0.0, 0.5}, {300.0, 900.0}, Interpolation::kStep)));
  at.go(-0.003, 0.2);
  at.hold(0.5);
  at.go(0.002, 0.3);
  EXPECT_LT(at.off, 1e-9);
  EXPECT_EQ(at.withheld(), 0u);
  EXPECT_NEAR(at.hand().stiffened_sum, 0.5 * 600.0 * 0.003 * 0.003, 1e-12);
}

TEST(Varying, AFallingStiffnessGivesNothing) {
  Varied at(stiffness(keys({0.3, 0.8}, {900.0, 300.0})));
  at.go(-0.003, 0.2);
  at.hold(0.8);
  at.go(0.002, 0.3);
  const double lost = 0.5 * 600.0 * 0.003 * 0.003;
  EXPECT_LT(at.off, 1e-9);
  EXPECT_EQ(at.hand().stiffened_sum, 0.0);
  EXPECT_NEAR(at.meter.work(), -lost, 0.01 * lost);
  EXPECT_NEAR(at.hand().safety.work, 0.0, 0.01 * lost) << "nothing is left that the hand could get elsewhere";
}

// What falls is forfeit: else every swing would be credited again.
TEST(Varying, ARestingHandGainsNoCreditBySwings) {
  Varied at(stiffness(keys({0.0, 0.05, 0.1}, {300.0, 900.0, 300.0}), true));
  at.go(-0.003, 0.2);
  at.hold(0.1);
  const double once = at.hand().safety.work;
  at.hold(2.0);
  EXPECT_NEAR(at.hand().safety.work, once, 1e-9);
  EXPECT_NEAR(once, -0.5 * at.world.registry.get<Deformable>(at.plate).stiffness * 0.003 * 0.003, 1e-12);
}

// Work of the law on the hand = loss of stored energy + what stiffness gained, over any motion; exact for the linear
// law.
TEST(Varying, EnergyIsConservedWhileHandAndStiffnessMove) {
  for (const SpringLaw law : {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential}) {
    Deformable deformable = Varied::smooth();
    deformable.spring = law;
    Varied at(stiffness(keys({0.0, 0.07, 0.13}, {300.0, 900.0, 300.0}), true), deformable);
    at.move(at.finger, {0, -0.0005, 0}, 0.1);
    const double begin = at.world.touch->objects[0].stored;
    scenes::WorkMeter raw;
    raw.add(at.read(at.finger));
    double gained = 0.0, size = 0.0;
    for (int i = 0; i <= 2000; ++i) {
      at.place(at.finger, {0, -0.0005 - 0.003 * std::pow(std::sin(0.00731 * i), 2), 0});
      at.tick();
      raw.add(at.read(at.finger));
      gained += at.hand().stiffened;
      size += std::abs(at.hand().stiffened);
    }
    const double left = at.world.touch->objects[0].stored - begin;
    EXPECT_GT(size, 1e-3);
    EXPECT_NEAR(raw.work() + left - gained, 0.0, law == SpringLaw::kLinear ? 1e-12 : 2e-4 * size) << int(law);
  }
}

TEST(Varying, FrictionAndDampingFollowTheirTracks) {
  Varying varying;
  varying.tracks.push_back({&DeformableParameters::friction_static, {0, 10}, keys({0.0, 2.0}, {0.8, 0.2})});
  varying.tracks.push_back({&DeformableParameters::friction_sliding, {0, 10}, keys({0.0, 2.0}, {0.8, 0.2})});
  Varied at(varying);
  at.move(at.finger, {-0.02, -0.002, 0}, 0.2);
  at.move(at.finger, {0.02, -0.002, 0}, 1.6, [&](const ProbeReading& reading) {
    if (at.time() < 0.5) return;
    const double mu = at.world.registry.get<Deformable>(at.plate).friction_sliding;
    EXPECT_NEAR(mu, 0.8 - 0.3 * (at.time() - at.dt()), 1e-12);
    EXPECT_NEAR(-reading.force.x, mu * 300.0 * 0.002, 1e-3 * mu);
  });
}

TEST(Varying, TheTickDoesNotAllocateAndRepeatsToTheBit) {
  std::uint64_t hash[2];
  for (std::uint64_t& each : hash) {
    Deformable deformable = Varied::smooth();
    deformable.spring = SpringLaw::kStandardLinearSolid;
    Varied at(stiffness(keys({0.0, 0.07, 0.13}, {300.0, 900.0, 300.0}), true), deformable);
    at.go(-0.001, 0.1);
    const CountAllocations allocations;
    for (int i = 0; i < 300; ++i) {
      at.place(at.finger, {0.001, -0.001 - 0.001 * std::sin(0.05 * i), 0.002});
      at.tick();
    }
    EXPECT_EQ(allocations.count(), 0u);
    each = at.hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

}  // namespace
}  // namespace pliant
