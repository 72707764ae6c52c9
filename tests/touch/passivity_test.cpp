// The passivity observer and its damping: forces that must not be changed, and energy that must be recovered.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "systems/safety/safety.h"

namespace pliant {
namespace {

constexpr double kDt = 1e-3;  // [s]

HapticDevice device_of_a_test() {
  HapticDevice device;
  device.driver = DriverKind::kScript;
  return device;
}

// A hand moved along a path through a force field.
struct Hand {
  SafetyState state;
  HapticDevice device = device_of_a_test();
  dvec3 position{0}, wanted{0}, sent{0};
  double work = 0.0, most_work = -1.0, largest_step = 0.0;
  bool any = false;

  void go(dvec3 to, dvec3 force) {
    const dvec3 last = sent;
    sent = make_safe(state, device, force, to, 0.0, kDt).force;
    if (any) work += 0.5 * dot(last + sent, to - position);
    most_work = std::max(most_work, work);
    largest_step = std::max(largest_step, length(sent - last));
    position = to;
    wanted = force;
    any = true;
  }
  const LimitCount& withheld() const { return state.tally.of(SafetyLimit::kWithheld); }
};

TEST(Passivity, ALosslessSpringIsNeverWithheldAtAnySpeed) {
  for (const double stiffness : {50.0, 300.0, 1500.0})
    for (const double speed : {0.001, 0.01, 0.05, 0.2, 0.5})
      for (const double force : {0.1, 0.5, 3.0}) {
        if (stiffness * speed > 800.0) continue;  // the slew limit then distorts the spring itself
        Hand hand;
        const double depth = force / stiffness, air = 3 * speed * kDt;
        const double period = 2 * (depth + air) / speed;
        for (int n = 0; n * kDt < 20 * period && n < 100000; ++n) {
          const double phase = std::fmod(n * kDt, period) * speed;
          const double y = air - (phase < depth + air ? phase : 2 * (depth + air) - phase);
          const dvec3 law(0, std::max(0.0, -stiffness * y), 0);
          hand.go({0, y, 0}, law);
          ASSERT_LT(length(hand.sent - law), 1e-12) << stiffness << ' ' << speed << ' ' << force << ' ' << n;
        }
        EXPECT_EQ(hand.withheld().ticks, 0u);
        EXPECT_EQ(hand.state.tally.of(SafetyLimit::kClipped).ticks, 0u);
      }
}

// -dU/dx of U = k(x) d^2 / 2 under a plane whose stiffness is painted, and of the same with a ball for the surface.
dvec3 painted_plane(dvec3 x) {
  const double depth = std::max(0.0, -x.y), k = 300 + 150 * std::sin(200 * x.x),
               slope = 150 * 200 * std::cos(200 * x.x);
  return {-0.5 * slope * depth * depth, k * depth, 0};
}
dvec3 ball(dvec3 x) {
  const dvec3 from = x - dvec3(0, -0.03, 0);
  const double r = length(from);
  return r < 0.03 ? 300 * (0.03 - r) / r * from : dvec3(0);
}

TEST(Passivity, LosslessLoopsAreNeverWithheld) {
  for (const auto& law : {std::function(painted_plane), std::function(ball)})
    for (const double turns : {0.5, 2.0, 5.0})  // [1/s]
      for (const double way : {1.0, -1.0})
        for (const double wide : {0.002, 0.015}) {
          Hand hand;
          for (int n = 0; n < 10000; ++n) {
            const double angle = way * 2 * M_PI * turns * n * kDt;
            const dvec3 x(wide * std::sin(angle), -0.001 + 0.003 * std::cos(angle), wide * 0.5 * std::sin(2 * angle));
            hand.go(x, law(x));
          }
          EXPECT_EQ(hand.withheld().ticks, 0u) << turns << ' ' << way << ' ' << wide;
          EXPECT_GT(hand.state.stored, 1e-4) << "it was pressed";
        }
}

TEST(Passivity, FrictionIsNeverWithheld) {
  Hand hand;
  dvec3 last(0);
  for (int n = 0; n < 10000; ++n) {
    const double t = n * kDt;
    const dvec3 x(0.01 * std::sin(5 * t), 0.002 * std::cos(7 * t), 0), v = (x - last) / kDt;
    const double normal = std::max(0.0, -400 * x.y);
    hand.go(x, {-0.4 * normal * v.x / std::max(std::abs(v.x), 1e-3), normal, 0});
    last = x;
  }
  EXPECT_EQ(hand.withheld().ticks, 0u);
}

// A press, then a slide along which the force jumps; it is not a gradient.
TEST(Passivity, WhatAJumpyForceGivesIsTakenBackInsideTheSlewLimitAndNeverByAZero) {
  Hand hand;
  dvec3 x(0, 1e-3, 0);
  hand.go(x, {0, 0, 0});
  for (; x.y > -2e-3; x.y -= 2e-5) hand.go(x, {0, std::max(0.0, -500 * x.y), 0});
  std::mt19937 random(7);
  double push = 0.0;
  int since_push = 0, longest = 0;
  for (int n = 0; n < 4000; ++n) {
    if (n % 40 == 0) push = (random() % 2) ? 1.5 : 0.0;  // [N] along the motion
    if (n > 3900) push = 0.0;
    x.x += 1e-4;
    hand.go(x, {push, 1.0, 0});
    ASSERT_NEAR(hand.sent.y, 1.0, 1e-2) << n << ": across the motion nothing is missing";
    ASSERT_GE(length(hand.sent), 0.99) << n;
    since_push = hand.state.work > kPassivityShare * hand.state.stored + 1e-9 ? since_push + 1 : 0;
    longest = std::max(longest, since_push);
  }
  EXPECT_GT(hand.withheld().ticks, 100u);
  EXPECT_GT(hand.withheld().largest_share, 0.5);
  EXPECT_LE(hand.withheld().largest_share, 1.0);
  EXPECT_LE(hand.largest_step, hand.device.max_slew * kDt * (1 + 1e-9));
  EXPECT_LE(longest, 5) << "ticks in a row in which the hand had more than it gave";
  EXPECT_LT(hand.work, kPassivityShare * hand.state.stored + 1e-9) << "and in the end nothing";
}

// An active force at its limit. The stopping distance holds for a hand that continues in this way; the rest is the
// trapezoidal error of unpredicted steps.
TEST(Passivity, AnActiveForceAtItsLimitPumpsLessThanATickOfItForEver) {
  std::mt19937 random(11);
  std::normal_distribution<double> g;
  for (const double shake : {0.0, 0.005})    // [m/s] of a trembling hand
    for (const double turns : {0.5, 3.0}) {  // [1/s]
      Hand hand;
      dvec3 x(0), tremble(0);
      double fastest = 0.0;
      hand.go(x, {0, 0, 0});
      for (int n = 1; n < 20000; ++n) {
        tremble = 0.95 * tremble + shake * dvec3(g(random), g(random), g(random));
        const dvec3 v = dvec3(0.1 * std::sin(2 * M_PI * turns * n * kDt), 0, 0) + tremble;
        fastest = std::max(fastest, length(v));
        x += kDt * v;
        hand.go(x, length(v) > 0 ? 3.0 / length(v) * v : dvec3(0));
      }
      const double one_tick = 3.0 * fastest * kDt;  // [J] work of the active force in every tick
      EXPECT_LT(hand.most_work, 0.1 * one_tick + kPassivityShare * hand.state.stored);
      EXPECT_LE(hand.largest_step, hand.device.max_slew * kDt * (1 + 1e-9));
    }
}

// The hand would get more energy than it put in: a spring that stiffened meanwhile.
TEST(Passivity, ASpringThatStiffensWhileItIsHeldGivesBackNoMoreThanItTook) {
  for (const double speed : {0.005, 0.05, 0.2}) {
    Hand hand;
    double y = 1e-3;
    for (; y > -3e-3; y -= speed * kDt) hand.go({0, y, 0}, {0, std::max(0.0, -300 * y), 0});
    for (int n = 0; n < 100; ++n) hand.go({0, y, 0}, {0, -900 * y, 0});
    for (; y < 2e-3; y += speed * kDt) hand.go({0, y, 0}, {0, std::max(0.0, -900 * y), 0});
    const double step = speed * kDt;  // [m] and the sampling uncertainty of a spring of 900 N/m at such steps
    EXPECT_LT(hand.work, 2 * kPassivityShare * hand.state.stored + 0.25 * 900 * step * step);
    EXPECT_GT(hand.withheld().ticks, 0u);
    EXPECT_LE(hand.largest_step, hand.device.max_slew * kDt * (1 + 1e-9));
    EXPECT_EQ(length(hand.sent), 0.0) << "in free space nothing drags";
  }
}

TEST(Passivity, EachLimitIsCountedByItself) {
  Hand clipped;
  clipped.go({0, 0, 0}, {0, 0, 0});
  for (int n = 1; n <= 100; ++n) clipped.go({0, -1e-4 * n, 0}, {0, 0.066 * n, 0});
  EXPECT_EQ(clipped.state.tally.of(SafetyLimit::kClipped).ticks, 50u);
  EXPECT_NEAR(clipped.state.tally.of(SafetyLimit::kClipped).largest_share, 0.5, 1e-9);
  EXPECT_EQ(clipped.state.tally.now, bit(SafetyLimit::kClipped));
  EXPECT_EQ(clipped.withheld().ticks, 0u);
  EXPECT_EQ(clipped.state.tally.of(SafetyLimit::kGated).ticks, 0u);

  Hand gated;
  for (int n = 0; n < 10; ++n) gated.go({0, -1e-3, 0}, {0, 0.5, 0});
  gated.go({0, 0, 0}, {0, 0, 0});
  EXPECT_EQ(gated.state.tally.of(SafetyLimit::kGated).ticks, 10u);
  EXPECT_EQ(gated.state.tally.of(SafetyLimit::kGated).largest_share, 1.0);
  EXPECT_EQ(gated.withheld().ticks, 0u);
  EXPECT_EQ(gated.state.tally.now, 0u);

  Hand slewed;
  slewed.go({0, 0, 0}, {0, 0, 0});
  for (int n = 0; n < 5; ++n) slewed.go({0, -1e-3, 0}, {0, 3, 0});
  EXPECT_EQ(slewed.state.tally.of(SafetyLimit::kSlewed).ticks, 2u) << "1 N a tick";
  EXPECT_NEAR(slewed.state.tally.of(SafetyLimit::kSlewed).largest_share, 2.0 / 3.0, 1e-9);
}

}  // namespace
}  // namespace pliant
