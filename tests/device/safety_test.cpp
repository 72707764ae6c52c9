#include "systems/safety/safety.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scenes/scenes.h"
#include "systems/schedule.h"

namespace pliant {
namespace {

using scenes::Stage;

HapticDevice plain() {
  HapticDevice d;
  d.driver = DriverKind::kExternal;
  return d;
}

TEST(Safety, OnlyFiniteClampedSlewLimitedForceLeavesWhateverIsAsked) {
  SafetyState state;
  HapticDevice device = plain();
  std::mt19937 random(2);
  std::normal_distribution<double> g;
  const double evil[] = {NAN, INFINITY, -INFINITY, 1e300, -1e30, 0.0, 5e-324};
  dvec3 last(0), x(0);
  for (int n = 0; n < 20000; ++n) {
    dvec3 wanted = 5.0 * dvec3(g(random), g(random), g(random));
    dvec3 position = x += 1e-4 * dvec3(g(random), g(random), g(random));
    if (n % 17 == 0) wanted[n % 3] = evil[random() % 7];
    if (n % 23 == 0) position[n % 3] = evil[random() % 7];
    device.sensed_at = n * 1e-3;
    const SafetyResult r = make_safe(state, device, wanted, position, n * 1e-3, 1e-3);
    ASSERT_TRUE(std::isfinite(length(r.force)));
    ASSERT_LE(length(r.force), device.max_force * (1 + 1e-12));
    // A fall to zero on unknown input may be abrupt; a rise never is.
    if (length(r.force) > length(last))
      ASSERT_LE(length(r.force - last), device.max_slew * 1e-3 + device.max_force * 1e-12);
    last = r.force;
  }
}

TEST(Safety, ASurfaceWhoseMotionIsUnknownGivesNoForce) {
  SafetyState state;
  const HapticDevice device = plain();
  SafetyLimits limits{3.3, 0.0, 1000.0};
  EXPECT_GT(make_safe(state, device, limits, {0, 0.1, 0}, dvec3(0), 0, 1e-3).force.y, 0.0);
  limits.carried = dvec3(NAN, 0, 0);
  const SafetyResult lost = make_safe(state, device, limits, {0, 0.1, 0}, {0, -1e-3, 0}, 0, 1e-3);
  EXPECT_EQ(lost.force, dvec3(0));
  EXPECT_EQ(lost.event, SafetyEvent::kNonFinite);
  limits.carried = dvec3(0);
  EXPECT_TRUE(std::isfinite(make_safe(state, device, limits, {0, 0.1, 0}, {0, -1e-3, 0}, 0, 1e-3).force.y));
}

TEST(Safety, ClampKeepsTheDirection) {
  SafetyState state;
  HapticDevice device = plain();
  device.max_slew = 1e9;
  make_safe(state, device, dvec3(0), dvec3(0), 0, 1e-3);
  const dvec3 wanted(3, 40, -5);
  const SafetyResult r = make_safe(state, device, wanted, {0, -1e-3, 0}, 0, 1e-3);
  EXPECT_NEAR(length(r.force), device.max_force, 1e-12);
  EXPECT_NEAR(dot(r.force, wanted) / length(r.force) / length(wanted), 1, 1e-12);
}

TEST(Safety, NothingLeavesUntilTheComputedForceHasBeenSmall) {
  SafetyState state;
  const HapticDevice device = plain();
  for (int n = 0; n < 5; ++n) EXPECT_EQ(make_safe(state, device, {0, 2, 0}, {0, -0.01, 0}, 0, 1e-3).force, dvec3(0));
  EXPECT_EQ(make_safe(state, device, {0, 0.1, 0}, {0, -0.01, 0}, 0, 1e-3).force.y, 0.1);
  EXPECT_GT(make_safe(state, device, {0, 0.5, 0}, {0, -0.011, 0}, 0, 1e-3).force.y, 0.1);
}

// A device that jumps: the force falls at the release rate, the jump does no work, and the gate closes. At speeds
// possible for a hand, nothing happens.
TEST(Safety, ADeviceThatJumpsIsLetGo) {
  HapticDevice device = plain();
  device.max_force = 10.0;
  device.max_slew = 500.0;
  const double dt = 1e-3, step = kFastestHand * dt;
  for (const bool jump : {false, true}) {
    SafetyState state;
    make_safe(state, device, dvec3(0), dvec3(0), 0, dt);
    for (int i = 1; i <= 10; ++i) make_safe(state, device, {0, 4, 0}, {0, -1e-4 * i, 0}, 0, dt);
    const double work = state.work;
    ASSERT_NEAR(state.force.y, 4.0, 1e-12);
    const double way = jump ? 0.3 : step;
    SafetyResult r = make_safe(state, device, {0, 4, 0}, {way, -1e-3, 0}, 0, dt);
    EXPECT_EQ(r.event, jump ? SafetyEvent::kJumped : SafetyEvent::kNone);
    EXPECT_NEAR(r.force.y, jump ? 4.0 - kLeastFall * dt : 4.0, 1e-12);
    if (!jump) continue;
    EXPECT_EQ(state.work, work);
    for (int i = 1; i < 8; ++i) {
      r = make_safe(state, device, {0, 4, 0}, {way, -1e-3, 0}, 0, dt);
      EXPECT_EQ(r.event, SafetyEvent::kNone);
      EXPECT_NEAR(r.force.y, std::max(0.0, 4.0 - kLeastFall * dt * (1 + i)), 1e-12);
    }
    EXPECT_GT(state.tally.of(SafetyLimit::kGated).ticks, 5u);
    EXPECT_EQ(make_safe(state, device, {0, 4, 0}, {way, -1e-3, 0}, 0, dt).force, dvec3(0)) << "still wanted";
    EXPECT_EQ(make_safe(state, device, {0, 0.1, 0}, {way, 0, 0}, 0, dt).force.y, 0.1) << "small: let in again";
  }
  // A device sampled every 50 ms may go farther between two samples.
  SafetyState state;
  device.sensed_at = 1.0;
  make_safe(state, device, dvec3(0), dvec3(0), 1.0, dt);
  device.sensed_at = 1.05;
  EXPECT_EQ(make_safe(state, device, dvec3(0), {0.5, 0, 0}, 1.05, dt).event, SafetyEvent::kNone);
}

// With any slew limit: force rises slowly, and unwanted force falls fast, along its own direction only.
TEST(Safety, ALowSlewLimitHoldsNoForceThatIsNoLongerWanted) {
  HapticDevice device = plain();
  device.max_slew = 1000.0;
  const double dt = 1e-3;
  const auto pressed = [&] {
    SafetyState state;
    make_safe(state, device, dvec3(0), dvec3(0), 0, dt);
    for (int i = 0; i < 5; ++i) make_safe(state, device, {0, 3, 0}, dvec3(0), 0, dt);
    EXPECT_NEAR(state.force.y, 3.0, 1e-12);
    return state;
  };
  SafetyState none = pressed(), across = pressed(), against = pressed(), less = pressed(), more = pressed();
  device.max_slew = 1.0;
  for (int i = 1; i <= 10; ++i) {
    const auto next = [&](SafetyState& state, dvec3 wanted) {
      return make_safe(state, device, wanted, dvec3(0), 0, dt).force;
    };
    const double left = std::max(0.0, 3.0 - kLeastFall * dt * i), in = device.max_slew * dt;
    EXPECT_NEAR(next(none, dvec3(0)).y, left, in) << i;
    const dvec3 turned = next(across, {3, 0, 0}), opposite = next(against, {0, -3, 0});
    EXPECT_NEAR(turned.y, left, in * i) << i;
    EXPECT_LE(turned.x, in * i * (1 + 1e-9)) << i;
    EXPECT_NEAR(opposite.y, left, in * i) << i;
    EXPECT_NEAR(next(less, {0, 0.5, 0}).y, std::max(0.5, left), in) << i;
    EXPECT_NEAR(next(more, {0, 3.2, 0}).y, 3.0 + in * i, 1e-12) << i;
  }
  EXPECT_EQ(none.force, dvec3(0));
  EXPECT_LT(against.force.y, 0.0) << "then it comes in, slowly";
}

// Work, stiffness and speed are in the hand's own metres if a driver's workspace is scaled to the world.
TEST(Safety, AScaledWorkspaceIsHeldToTheHandsOwnMetres) {
  for (const double scale : {0.1, 1.0, 10.0}) {
    SafetyState state;
    HapticDevice device = plain();
    device.workspace = scale;
    device.max_stiffness = 300.0;  // of the world
    device.max_force = 100.0;
    device.max_slew = 1e9;
    const double most = 300.0 * scale;  // [N/m] of the hand
    make_safe(state, device, dvec3(0), dvec3(0), 0, 1e-3);
    double before = 0.0;
    for (int n = 1; n < 50; ++n) {
      const dvec3 world(0, -1e-5 * scale * n, 0);
      const double force = make_safe(state, device, {0, 1e4 * 1e-5 * n, 0}, world, 0, 1e-3).force.y;
      EXPECT_NEAR(force - before, most * 1e-5, most * 1e-11) << scale;
      before = force;
    }
    EXPECT_NEAR(-state.work, 0.5 * most * std::pow(49e-5, 2), 1e-9) << "in joules of the hand";
  }
}

TEST(Safety, PassivityHoldsForAnActiveForceToo) {
  // A force that always pushes along the motion: an engine, if nothing stopped it.
  SafetyState state;
  HapticDevice device = plain();
  dvec3 x(0), v(0), last(0), last_x(0);
  double work = 0;
  std::mt19937 random(4);
  std::normal_distribution<double> g;
  for (int n = 0; n < 5000; ++n) {
    v = 0.95 * v + 0.002 * dvec3(g(random), g(random), g(random));
    x += 1e-3 * v;
    device.sensed_at = n * 1e-3;
    const dvec3 f = make_safe(state, device, 40.0 * v, x, n * 1e-3, 1e-3).force;
    if (n) work += 0.5 * dot(f + last, x - last_x);
    last = f, last_x = x;
    ASSERT_LT(work, 2e-6) << n;  // at most what one unforeseen step can carry
  }
}

SafetyLimits hanging(dvec3 weight) {
  return {.force = 3.3, .stiffness = 0.0, .slew = 1000.0, .weight = weight};
}

TEST(Safety, AWeightThatIsKnownComesInFromZeroAndAgainAfterALoss) {
  const dvec3 weight(0, -2, 0);
  for (const double stiffness : {0.0, 400.0}) {
    SafetyState state;
    HapticDevice device = plain();
    SafetyLimits limits = hanging(weight);
    limits.stiffness = stiffness;
    for (int life = 0; life < 2; ++life) {
      dvec3 last(0);
      for (int n = 0; n < 1000; ++n) {
        const dvec3 f = make_safe(state, device, limits, weight, {0, 0, 0}, 0, 1e-3).force;
        ASSERT_LE(length(f - last), 2.0 * 1e-3 / kWeightTime * (1 + 1e-9)) << n;
        ASSERT_NEAR(f.y, -2.0 * std::min(1.0, n * 1e-3 / kWeightTime), 1e-12) << n;
        last = f;
      }
      device.status = DeviceStatus::kLost;
      EXPECT_EQ(make_safe(state, device, limits, weight, {0, 0, 0}, 0, 1e-3).force, dvec3(0));
      device.status = DeviceStatus::kReady;
    }
  }
}

TEST(Safety, AWeightOpensTheGateForNothingElse) {
  const dvec3 weight(0, -2, 0);
  for (const dvec3 beside : {dvec3(0, 1, 0), dvec3(0, -0.3, 0), dvec3(0.5, 0, 0)}) {
    SafetyState state;
    for (int n = 0; n < 1000; ++n)
      ASSERT_EQ(make_safe(state, plain(), hanging(weight), weight + beside, {}, 0, 1e-3).force, dvec3(0));
  }
  // A resting weight is felt at once at its value, and not as an upward push.
  SafetyState state;
  EXPECT_EQ(make_safe(state, plain(), hanging(weight), {0, -0.1, 0}, {}, 0, 1e-3).force, dvec3(0, -0.1, 0));
  const dvec3 nothing(NAN, 0, 0);
  EXPECT_EQ(make_safe(state, plain(), hanging(nothing), {0, -0.1, 0}, {}, 0, 1e-3).force, dvec3(0));
}

// The hand gets no more than lowering the weight as far as it has been lowered gives, once.
TEST(Safety, AWeightStaysWhereverItIsCarriedAndLendsNothingToOtherForces) {
  const dvec3 weight(0, -1, 0);
  for (const double engine : {0.0, 40.0}) {  // [N s/m] in addition, a force along the motion
    SafetyState state;
    dvec3 x(0), v(0), last(0), last_x(0);
    double work = 0, lowered = 0;
    std::mt19937 random(4);
    std::normal_distribution<double> g;
    for (int n = 0; n < 5000; ++n) {
      v = n < 600 ? dvec3(0) : 0.95 * v + 0.002 * dvec3(g(random), g(random), g(random)) - dvec3(0, 1e-3, 0);
      x += 1e-3 * v;
      const dvec3 f = make_safe(state, plain(), hanging(weight), weight + engine * v, x, 0, 1e-3).force;
      work += 0.5 * dot(f + last, x - last_x);
      lowered = std::max(lowered, dot(weight, x));
      last = f, last_x = x;
      if (n > 600 && engine == 0.0) {
        ASSERT_LT(length(f - weight), 1e-12) << n;
      }
      ASSERT_LT(work, lowered + 4e-6) << n;  // a tenth of what the engine does in one tick: an unforeseen turn
    }
    EXPECT_LT(x.y, -0.05) << "it went down";
  }
}

TEST(Safety, StiffnessLimitBoundsHowFastForceGrowsWithDisplacement) {
  SafetyState state;
  HapticDevice device = plain();
  device.max_stiffness = 400;
  device.max_slew = 1e9;
  make_safe(state, device, dvec3(0), dvec3(0), 0, 1e-3);
  dvec3 last(0);
  for (int n = 1; n < 100; ++n) {
    const dvec3 f = make_safe(state, device, {0, 5000 * 1e-5 * n, 0}, {0, -1e-5 * n, 0}, 0, 1e-3).force;
    ASSERT_LE(f.y - last.y, 400 * 1e-5 * (1 + 1e-9));
    last = f;
  }
  EXPECT_GT(last.y, 0.3);
}

}  // namespace
}  // namespace pliant
