// The state machine: conditions that open, close or latch it; no limit is ever raised.
#include "devices/guard/guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/guard/hand_rig.h"

namespace pliant {
namespace {

using testing::HasSubstr;

// A guard that is stepped manually by one millisecond, with a fresh sample and model unless specified otherwise.
struct Bench {
  DeviceCapabilities can{.max_force = 3.0, .rate = 1000.0};
  Guard guard;
  double now = 1.0;
  DeviceSample sample;
  GuardInput wanted;
  bool sampled = true;
  explicit Bench(const GuardParameters& parameters = {}) : guard(can, parameters) { wanted.known = true; }
  DeviceWrench step(const GuardOrders& orders = {}) {
    now += 1e-3;
    sample.position.z = 1e-5 * static_cast<double>(++count % 3);
    guard.sense(sampled ? &sample : nullptr, now, orders);
    return guard.release(wanted, now, orders);
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) step();
  }
  void activate() {
    wanted.wrench = {};
    run(100);
    ASSERT_EQ(guard.state(), DeviceState::kActive);
    run(300);
  }
  int count = 0;
};

TEST(Guard, ADeviceArmsItselfOnceSamplesAreFreshAndForceLeavesOnlyBehindTheGateAndTheRamp) {
  Bench bench;
  bench.wanted.wrench.force = {0, 1.0, 0};
  EXPECT_EQ(bench.guard.state(), DeviceState::kDisconnected);
  bench.step();
  EXPECT_EQ(bench.guard.state(), DeviceState::kIdle);
  bench.run(100);
  EXPECT_EQ(bench.guard.state(), DeviceState::kArmed) << "1 N is wanted: the gate is closed";
  EXPECT_EQ(length(bench.step().force), 0.0);
  bench.wanted.wrench.force.y = 0.1;
  bench.step();
  EXPECT_EQ(bench.guard.state(), DeviceState::kActive);
  bench.wanted.wrench.force.y = 1.0;
  double last = 0.0;
  for (int i = 0; i < 250; ++i) {
    const double force = length(bench.step().force);
    EXPECT_GE(force, last);
    if (i > 0) EXPECT_LE(force - last, 1.0 / 200 + 1e-9) << "the ramp of 0.2 s";
    last = force;
  }
  EXPECT_NEAR(last, 1.0, 1e-9);
}

// After a stall the touch tick's force fades in from zero: small, although a hand presses.
TEST(Guard, ASmallForceThatFadesInOpensNoGate) {
  Bench bench;
  bench.wanted.wrench.force = {0, 0.1, 0};
  bench.wanted.easing = true;
  bench.run(300);
  EXPECT_EQ(bench.guard.state(), DeviceState::kArmed);
  bench.wanted.easing = false;
  bench.step();
  EXPECT_EQ(bench.guard.state(), DeviceState::kActive);
}

TEST(Guard, ADeviceThatIsArmedByHandDoesNotArmItself) {
  Bench bench({.arming = Arming::kByHand});
  bench.run(1000);
  EXPECT_EQ(bench.guard.state(), DeviceState::kIdle);
  bench.step({.arm = true});
  bench.step();
  EXPECT_EQ(bench.guard.state(), DeviceState::kActive) << "nothing is wanted: the gate is open at once";
  bench.step({.disarm = true});
  bench.run(1000);
  EXPECT_EQ(bench.guard.state(), DeviceState::kIdle);
}

TEST(Guard, ADisarmedDeviceStaysSoUntilAPersonArmsIt) {
  Bench bench;
  bench.activate();
  bench.step({.disarm = true});
  bench.run(1000);
  EXPECT_EQ(bench.guard.state(), DeviceState::kIdle);
  bench.step({.arm = true});
  bench.step();
  EXPECT_EQ(bench.guard.state(), DeviceState::kActive);
}

TEST(Guard, TheDeadManButtonOpensTheGateUnderAnyForceAndClosesItAtOnce) {
  Bench bench({.dead_man = 2});
  bench.wanted.wrench.force.y = 1.0;
  bench.run(200);
  EXPECT_EQ(bench.guard.state(), DeviceState::kArmed);
  bench.sample.buttons = 1;
  bench.run(10);
  EXPECT_EQ(bench.guard.state(), DeviceState::kArmed) << "another button";
  bench.sample.buttons = 2;
  bench.run(300);
  EXPECT_NEAR(length(bench.step().force), 1.0, 1e-9);
  bench.sample.buttons = 0;
  EXPECT_EQ(length(bench.step().force), 0.0);
  EXPECT_EQ(bench.guard.report().cause, DeviceCause::kDeadManReleased);
}

TEST(Guard, AnEmergencyStopLatchesFromEveryStateAndWinsOverArming) {
  for (const int steps : {0, 1, 60, 400}) {
    Bench bench;
    bench.run(steps);
    EXPECT_EQ(length(bench.step({.arm = true, .stop = true}).force), 0.0);
    EXPECT_EQ(bench.guard.state(), DeviceState::kTripped) << steps;
    EXPECT_TRUE(bench.guard.take_make_safe());
    bench.run(1000);
    EXPECT_EQ(bench.guard.state(), DeviceState::kTripped) << steps;
    bench.step({.arm = true});
    EXPECT_EQ(bench.guard.state(), DeviceState::kActive) << steps;
  }
}

TEST(Guard, ASampleIsMissedFromTenMillisecondsOnAndLatchedFromAHundred) {
  Bench bench;
  bench.activate();
  bench.wanted.wrench.force.y = 0.5;
  bench.run(50);
  bench.sampled = false;
  for (int i = 1; i <= 120; ++i) {
    const double force = length(bench.step().force);
    if (i <= 9) EXPECT_GT(force, 0.0) << i;
    if (i >= 11) EXPECT_EQ(force, 0.0) << i;
    if (i >= 12 && i <= 99) EXPECT_EQ(bench.guard.state(), DeviceState::kArmed) << i;
  }
  EXPECT_EQ(bench.guard.state(), DeviceState::kTripped);
  EXPECT_EQ(bench.guard.report().cause, DeviceCause::kLost);
  bench.step({.arm = true});
  EXPECT_EQ(bench.guard.state(), DeviceState::kTripped) << "not without a sample";
  bench.sampled = true;
  bench.step();
  bench.step({.arm = true});
  EXPECT_EQ(bench.guard.state(), DeviceState::kArmed) << "0.5 N is wanted: not before it was small";
}

TEST(Guard, FiveLossesInASecondTripIt) {
  Bench bench;
  bench.activate();
  for (int n = 0; n < 5; ++n) {
    ASSERT_EQ(bench.guard.state(), DeviceState::kActive) << n;
    bench.sampled = false;
    bench.run(15);
    bench.sampled = true;
    bench.run(5);
  }
  EXPECT_EQ(bench.guard.state(), DeviceState::kTripped);
  EXPECT_EQ(bench.guard.report().cause, DeviceCause::kUnsteady);
}

TEST(Guard, NoParameterLiftsADevicesLimit) {
  Bench bench({.max_force = 50.0, .max_velocity = 50.0});
  bench.activate();
  bench.wanted.max_force = 40.0;
  bench.wanted.wrench.force = {30.0, 40.0, 0};
  DeviceWrench wrench;
  for (int i = 0; i < 400; ++i) wrench = bench.step();
  EXPECT_LE(length(wrench.force), 3.0 * (1 + 1e-12));
  EXPECT_NEAR(wrench.force.y / wrench.force.x, 4.0 / 3.0, 0.01) << "by the norm, so that the direction stays";
  Bench lower({.max_force = 1.0});
  lower.activate();
  lower.wanted.wrench.force = {30.0, 40.0, 0};
  for (int i = 0; i < 400; ++i) wrench = lower.step();
  EXPECT_LE(length(wrench.force), 1.0 * (1 + 1e-12));
}

TEST(Guard, AForceThatLastsIsLoweredToWhatTheMotorsBear) {
  Bench bench;
  bench.can.continuous_force = 1.0;
  bench.guard = Guard(bench.can);
  bench.activate();
  bench.wanted.wrench.force.y = 3.0;
  double square = 0.0;
  for (int i = 0; i < 120'000; ++i) {
    const double force = length(bench.step().force);
    square += (1.0 - std::exp(-1e-3 / kThermalTime)) * (force * force - square);
    ASSERT_LE(square, 1.0 + 1e-3) << "the mean square over the thermal time, at " << i;
  }
  EXPECT_NEAR(length(bench.step().force), 1.0, 0.05);
}

TEST(Guard, TheStableStiffnessIsColgatesAndFallsWithRateAndLatency) {
  DeviceCapabilities can{.max_stiffness = 0.0, .damping = 0.5};
  EXPECT_NEAR(stable_stiffness(can, 1000.0), 2 * 0.5 / 1e-3, 1e-9);
  EXPECT_NEAR(stable_stiffness(can, 4000.0), 2 * 0.5 / 0.25e-3, 1e-9);
  EXPECT_NEAR(stable_stiffness(can, 1000.0, 0.2), 2 * 0.3 / 1e-3, 1e-9);
  can.latency = 1e-3;
  EXPECT_NEAR(stable_stiffness(can, 1000.0), 0.5 / 1.5e-3, 1e-9);
  can.max_stiffness = 100.0;
  EXPECT_EQ(stable_stiffness(can, 1000.0), 100.0) << "what the device says is not raised";
  EXPECT_EQ(stable_stiffness({.max_stiffness = 700.0}, 1000.0), 700.0);
}

TEST(Guard, ABrakeIsNeverWrittenAForceAlongTheMotion) {
  Bench bench;
  bench.can.resists_only = true;
  bench.guard = Guard(bench.can);
  bench.activate();
  double along = 0.0, against = 0.0;
  for (int i = 0; i < 4000; ++i) {
    bench.now += 1e-3;
    const double phase = 5e-3 * i;
    bench.sample.position = {0.01 * std::sin(phase), 0, 0};
    bench.wanted.wrench.force = {1.0, 0, 0};
    bench.guard.sense(&bench.sample, bench.now, {});
    const DeviceWrench wrench = bench.guard.release(bench.wanted, bench.now, {});
    const double power = dot(wrench.force, bench.guard.velocity());
    along = std::max(along, power);
    against = std::min(against, power);
  }
  EXPECT_EQ(along, 0.0);
  EXPECT_LT(against, -0.01) << "it does brake";
}

TEST(Guard, EveryTransitionIsKeptWithItsCauseItsTimeAndTheForceBefore) {
  Bench bench;
  bench.activate();
  bench.wanted.wrench.force.y = 0.5;
  bench.run(100);
  bench.step({.stop = true});
  const DeviceReport& report = bench.guard.report();
  ASSERT_EQ(report.transitions, 4u);
  EXPECT_EQ(report.transition(0).cause, DeviceCause::kConnected);
  EXPECT_EQ(report.transition(1).cause, DeviceCause::kArmedByItself);
  EXPECT_EQ(report.transition(2).cause, DeviceCause::kSmallForce);
  EXPECT_NEAR(report.transition(3).force, 0.5, 1e-9);
  EXPECT_NEAR(report.transition(3).time, bench.now, 1e-12);
  EXPECT_THAT(describe(report.transition(3)), HasSubstr("active -> tripped at"));
  EXPECT_THAT(describe(report.transition(3)), HasSubstr("emergency stop"));
  for (int i = 0; i < 100; ++i) bench.step({.arm = true}), bench.step({.stop = true});
  const DeviceReport& later = bench.guard.report();
  ASSERT_GT(later.transitions, DeviceReport::kKept);
  for (std::uint64_t i = 1; i < DeviceReport::kKept; ++i)
    EXPECT_GE(later.transition(i).time, later.transition(i - 1).time) << "oldest first";
}

TEST(Guard, EveryStateAndCauseHasItsOwnSentence) {
  std::vector<std::string> seen;
  for (int cause = 1; cause <= static_cast<int>(DeviceCause::kClosed); ++cause) {
    const std::string text = describe({.cause = static_cast<DeviceCause>(cause)});
    EXPECT_GT(text.substr(text.find(": ") + 2).size(), 5u) << cause;
    EXPECT_THAT(seen, testing::Not(testing::Contains(text)));
    seen.push_back(text);
  }
}

// A wall of the closed form, without a fault: the guard adds nothing and takes nothing away.
TEST(Servo, AHandInAWallFeelsTheLawItselfAndGetsNoMoreThanItGave) {
  WallRig rig;
  rig.press();
  const double depth = -rig.device.hand.y;
  EXPECT_NEAR(rig.device.written, WallRig::kStiffness * depth, 0.02);
  for (int i = 0; i < 6000; ++i) {
    rig.device.hand.wants = -0.004 + 0.006 * std::sin(2e-3 * i);
    rig.tick();
  }
  EXPECT_EQ(rig.servo.state(), DeviceState::kActive);
  EXPECT_EQ(rig.servo.report().transitions, 3u) << "connected, armed, active, and nothing since";
}

// Between two ticks of the touch clock the force follows the device.
TEST(Servo, ALateTouchTickIsAnExtrapolationAndNotAHeldForce) {
  WallRig rig;
  rig.press();
  rig.touch_runs = false;
  const double before = rig.device.hand.y;
  rig.device.hand.wants -= 0.004;
  rig.run(0.006);
  const double went = before - rig.device.hand.y;
  ASSERT_GT(went, 1e-4);
  EXPECT_NEAR(rig.device.written, -WallRig::kStiffness * rig.device.hand.y, WallRig::kStiffness * went * 0.5);
}

TEST(Servo, TheSameTicksGiveTheSameBits) {
  const auto run = [] {
    WallRig rig;
    rig.press();
    rig.run(0.5);
    return std::pair(rig.device.hand.y, rig.device.written);
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace pliant
