// One axis of a device held by a hand, against closed forms.
#include "devices/simulated/axis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pliant {
namespace {

TEST(Axis, MassWithDampingFollowsTheClosedForm) {
  for (const double b : {0.0, 0.1, 5.0}) {
    Axis axis({.mass = 0.045, .damping = b});
    axis.place(0.01);
    axis.kick(-0.2);
    axis.command(0.5);
    const double t = 0.037, m = 0.045;
    for (int i = 0; i < 37; ++i) axis.advance(1e-3);
    const double x = b > 0 ? 0.01 + 0.5 / b * t + (-0.2 - 0.5 / b) * m / b * (1 - std::exp(-b * t / m))
                           : 0.01 - 0.2 * t + 0.5 * 0.5 / m * t * t;
    EXPECT_NEAR(axis.position(), x, 1e-13);
  }
}

TEST(Axis, AmplifierLagsByItsTimeConstant) {
  Axis axis({.mass = 1.0, .lag = 2e-3});
  axis.command(3.0);
  axis.advance(2e-3);
  EXPECT_NEAR(axis.motor(), 3.0 * (1 - std::exp(-1.0)), 1e-12);
}

// A hand of one mass on the arm's spring, the device on a stiff grip: both oscillate as one mass.
TEST(Axis, StepLengthDoesNotChangeWhereTheHandGoes) {
  const AxisParameters parameters{
      .mass = 0.1, .damping = 0.5, .friction = 0.2, .lag = 0.4e-3, .hand = hand_impedances()[3]};
  Axis coarse(parameters), fine(parameters);
  for (int i = 0; i < 500; ++i) {
    const double from = 0.02 * std::sin(0.01 * i), to = 0.02 * std::sin(0.01 * (i + 1));
    coarse.command(i % 7 * 0.3 - 1.0);
    fine.command(i % 7 * 0.3 - 1.0);
    coarse.advance(1e-3, {from, to, 0.1});
    for (int k = 0; k < 40; ++k)
      fine.advance(25e-6, {from + (to - from) * k / 40.0, from + (to - from) * (k + 1) / 40.0, 0.1});
    ASSERT_NEAR(coarse.position(), fine.position(), 1e-7) << i;
  }
}

// Against a finely sampled spring: each half-swing loses 2c/k.
TEST(Axis, CoulombFrictionTakesTheSameFromEverySwing) {
  const double k = 200.0, c = 0.05, dt = 1e-6;
  Axis axis({.mass = 0.1, .friction = c});
  axis.place(0.01);
  std::vector<double> turns;
  double last_v = 0.0;
  for (int i = 0; i < 2'000'000; ++i) {
    axis.command(-k * axis.position());
    axis.advance(dt);
    if (axis.velocity() * last_v < 0.0 || (axis.velocity() == 0.0 && last_v != 0.0)) turns.push_back(axis.position());
    if (axis.velocity() != 0.0 || axis.sticks()) last_v = axis.velocity();
  }
  ASSERT_GT(turns.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i)
    EXPECT_NEAR(std::abs(turns[i]), 0.01 - 2.0 * (static_cast<double>(i) + 1) * c / k, 2e-5) << i;
  EXPECT_TRUE(axis.sticks());
  EXPECT_LE(std::abs(axis.position()), c / k);
}

TEST(Axis, DeviceSticksExactlyUntilFrictionIsOvercome) {
  Axis axis({.mass = 0.1, .friction = 0.26});
  axis.place(0.003);
  axis.command(0.2599);
  for (int i = 0; i < 1000; ++i) axis.advance(1e-3);
  EXPECT_EQ(axis.position(), 0.003);
  axis.command(-0.2601);
  for (int i = 0; i < 1000; ++i) axis.advance(1e-3);
  EXPECT_NEAR(axis.position(), 0.003 - 0.5 * 0.0001 / 0.1, 1e-12);
}

// Break-away within a step: the amplifier's force passes c at a known time.
TEST(Axis, BreaksLooseInTheMiddleOfAStep) {
  const double tau = 1e-3, c = 0.5, u = 1.0, m = 0.2;
  Axis axis({.mass = m, .friction = c, .lag = tau});
  axis.command(u);
  axis.advance(5e-3);
  const double t0 = -tau * std::log(1 - c / u), t = 5e-3 - t0;
  // From t0 on: m x'' = u - c - (u - c) e^(-t/tau).
  const double x = (u - c) / m * (0.5 * t * t - tau * t + tau * tau * (1 - std::exp(-t / tau)));
  EXPECT_NEAR(axis.position(), x, 1e-10);
}

// Kelvin-Voigt: in the end stop the mass is a damped oscillator, until the stop would have to pull.
TEST(Axis, EndStopThrowsBackAsADampedSpringAndNeverPulls) {
  const double m = 0.1, k = 2e4, reach = 0.05, v0 = 0.8;
  for (const double ratio : {0.0, 0.1, 0.5}) {
    const double natural = std::sqrt(k / m), damped = natural * std::sqrt(1 - ratio * ratio);
    const double t = 2.0 * std::acos(ratio) / damped;  // k d + b d' = 0
    const double x = v0 / damped * std::exp(-ratio * natural * t) * std::sin(damped * t);
    const double v =
        v0 * std::exp(-ratio * natural * t) * (std::cos(damped * t) - ratio * natural / damped * std::sin(damped * t));
    for (const double side : {1.0, -1.0}) {
      Axis axis({.mass = m, .reach = reach, .stop_stiffness = k, .stop_damping = 2.0 * ratio * std::sqrt(k * m)});
      axis.place(side * (reach - 0.5e-3 * v0));  // half a millisecond before the stop
      axis.kick(side * v0);
      bool pushed = false;
      for (int i = 0; i < 30; ++i) {
        axis.advance(1e-3);
        pushed = pushed || axis.stopped();
      }
      EXPECT_TRUE(pushed);
      EXPECT_FALSE(axis.stopped());
      EXPECT_NEAR(side * axis.velocity(), v, 1e-6) << ratio;
      EXPECT_NEAR(side * axis.position(), reach + x + v * (0.03 - 0.5e-3 - t), 1e-7) << ratio;
    }
  }
}

TEST(Axis, AgainstItsEndStopItRestsWhereTheSpringBearsTheForce) {
  Axis axis({.mass = 0.1, .damping = 1.0, .reach = 0.05, .stop_stiffness = 2e4, .stop_damping = 20.0});
  axis.command(3.0);
  for (int i = 0; i < 2000; ++i) axis.advance(1e-3);
  EXPECT_NEAR(axis.position(), 0.05 + 3.0 / 2e4, 1e-9);
  EXPECT_TRUE(axis.stopped());
  axis.command(-0.5);
  for (int i = 0; i < 2; ++i) axis.advance(1e-3);
  EXPECT_LT(axis.velocity(), 0.0) << "nothing holds it";
}

TEST(Axis, NothingMovesByItselfAndNoEnergyComesFromNowhere) {
  for (const HandImpedance& hand : hand_impedances()) {
    Axis axis({.mass = 0.1, .damping = 0.1, .friction = 0.05, .hand = hand});
    axis.place(0.02);
    axis.advance(0.1, {0.02, 0.02, 0.0});
    EXPECT_EQ(axis.position(), 0.02) << hand.name;
    axis.kick(0.3);
    double energy = axis.energy() + 0.0;
    for (int i = 0; i < 300; ++i) {
      axis.advance(1e-3, {0.02, 0.02, 0.0});
      const double arm = axis.hand_position() - 0.02;
      const double now = axis.energy() + 0.5 * hand.arm_stiffness * arm * arm;
      ASSERT_LE(now, energy * (1 + 1e-12) + 1e-18) << hand.name << ' ' << i;
      energy = now;
    }
  }
}

}  // namespace
}  // namespace pliant
