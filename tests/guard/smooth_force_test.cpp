// What is written to a device, judged as a force: a hand that comes into a wall while the guard lets its force in is to
// feel the wall, not a force that is switched. Over a grid of hands, walls, rates and moments.
#include "scenes/exact_hand.h"
#include "tests/guard/hand_rig.h"

namespace pliant {
namespace {

// Driver, servo and guard as they are; the wall is a touch tick's at 1 kHz.
struct Press {
  double wall = 400.0, rate = 1000.0;
  ExactHand hand;
  FaultyDevice device;
  std::unique_ptr<Servo> servo;
  double time = 0.0, deepest = 0.0;
  double sampled = 0.0;  // [J] that sampling a spring gives, K T v^2 / 2 dt: stable_stiffness()'s business
  DeviceSample sample;
  bool heard = false;
  std::function<void(DeviceModel&)> law;

  explicit Press(double wall_stiffness, double servo_rate, const ExactHand& who, DeviceCapabilities can = {})
      : wall(wall_stiffness), rate(servo_rate), hand(who) {
    can.rate = rate;
    can.workspace = {0.1, 0.1, 0.1};
    if (!(can.max_force > 0.0)) can.max_force = 3.3;
    device.can = can;
    servo = std::make_unique<Servo>(std::make_unique<FaultyDriver>(device));
    EXPECT_TRUE(servo->open(""));
  }

  void tick(double wants, Written* written = nullptr) {
    if (servo->read(sample)) heard = true;
    if (heard) {
      DeviceModel model;
      model.position = sample.position;
      model.max_force = 3.3;
      if (sample.position.y < 0.0) {
        model.wrench.force.y = -wall * sample.position.y;
        model.force_by_position[1][1] = -wall;
      }
      if (law) law(model);
      servo->write_model(model, model.wrench);
    }
    const int periods = static_cast<int>(std::lround(rate * 1e-3));
    for (int i = 0; i < periods; ++i) {
      time += 1e-3 / periods;
      device.now = time;
      device.hand.y = hand.y;
      const double before = device.written;
      servo->period(time);
      const double wanted = std::min(3.3, std::max(0.0, -wall * hand.y));
      if (written) written->add(device.written, before, wanted);
      hand.step(device.written, wants, 1e-3 / periods);
      deepest = std::max(deepest, -hand.y);
      if (hand.y < 0.0) sampled += 0.5 * wall / rate * hand.v * hand.v * 1e-3 / periods;
    }
  }
  void run(double seconds, double wants, Written* written = nullptr) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds * 1e3)); ++i) tick(wants, written);
  }
  // Moves there at constant speed.
  void go(double seconds, double from, double to) {
    const int ticks = static_cast<int>(std::lround(seconds * 1e3));
    for (int i = 1; i <= ticks; ++i) tick(from + (to - from) * i / ticks);
  }
  void until_active() {
    for (int i = 0; i < 200 && servo->state() != DeviceState::kActive; ++i) tick(0.004);
    ASSERT_EQ(servo->state(), DeviceState::kActive);
  }
};

TEST(SmoothForce, AHandThatComesInDuringTheRampFeelsTheWallAndNoSwitchedForce) {
  int hands = 0;
  for (const double mass : {0.05, 0.15, 0.5})
    for (const double damping : {1.0, 5.0})
      for (const double stiffness : {100.0, 300.0})
        for (const double wall : {200.0, 400.0, 1000.0})
          for (const double rate : {1000.0, 4000.0})
            for (const double start : {0.0, 0.03, 0.08, 0.15}) {
              // At rest after 2 s without a guard, too: the law itself is not in question.
              if ((damping - 0.5 * wall / rate) / (2.0 * mass) < 2.0) continue;
              Press press(wall, rate, {mass, damping, stiffness, 0.004});
              press.until_active();
              press.run(start, 0.004);
              const double goal = -0.63 / stiffness;
              press.go(0.04, 0.004, goal);
              press.run(2.0, goal);
              Written written;
              press.run(0.25, goal, &written);
              ++hands;
              const std::string who = testing::PrintToString(std::array{mass, damping, stiffness, wall, rate, start});
              ASSERT_EQ(press.servo->state(), DeviceState::kActive) << who;
              EXPECT_EQ(written.zeros, 0) << who;
              EXPECT_NEAR(written.mean / written.wanted, 1.0, 0.02) << who;
              EXPECT_LT(written.step, 0.02) << who;
              // No more energy than the whole force would have had in store where the hand came to.
              const double most = 0.5 * wall * press.deepest * press.deepest;
              press.go(0.3, goal, 0.004);
              EXPECT_LT(press.hand.work, most * 1.02 + 1.2 * press.sampled + 5e-6) << who;
              // And none from then on: the written force is a passive wall's.
              const double had = press.hand.work - 1.2 * press.sampled;
              for (int i = 0; i < 3; ++i) press.go(0.2, 0.004, goal), press.go(0.2, goal, 0.004);
              EXPECT_LT(press.hand.work, had + 1.2 * press.sampled + 5e-6) << who;
            }
  EXPECT_GE(hands, 200);
}

// At rest in contact, after any history: the full wanted force, without switching.
void expect_whole(Press& press, double wants, const std::string& what) {
  Written written;
  press.run(0.2, wants, &written);
  ASSERT_EQ(press.servo->state(), DeviceState::kActive) << what << describe(press.servo->report().cause);
  EXPECT_EQ(written.zeros, 0) << what;
  EXPECT_NEAR(written.mean / written.wanted, 1.0, 0.03) << what;
  EXPECT_LT(written.step, 0.03) << what;
}

ExactHand light() {
  return {0.1, 3.0, 300.0, 0.004};
}

TEST(SmoothForce, TheGateMayOpenInContactAndTheForceComesInWhole) {
  for (const double wall : {200.0, 1000.0})
    for (const double push : {0.15, 0.63, 2.0}) {
      Press press(wall, 1000.0, light());
      const double goal = -push / 300.0, touching = -0.15 / wall;
      press.hand.y = -0.15 / wall;
      for (int i = 0; i < 400 && press.servo->state() != DeviceState::kActive; ++i) press.tick(touching);
      ASSERT_EQ(press.servo->state(), DeviceState::kActive);
      press.go(0.05, touching, goal);
      press.run(1.5, goal);
      expect_whole(press, goal, "gate in contact");
    }
}

TEST(SmoothForce, AfterALimitIsRaisedAWarningEndsOrTheForceHasFadedItComesBackWhole) {
  const double goal = -2.5 / 300.0;
  for (const double wall : {200.0, 1000.0}) {
    Press raised(wall, 1000.0, light());
    double limit = 0.4;
    raised.law = [&](DeviceModel& model) { model.max_force = limit; };
    raised.until_active();
    raised.run(0.3, 0.004);
    raised.go(0.6, 0.004, goal);  // more slowly than a runaway
    raised.run(1.0, goal);
    EXPECT_NEAR(raised.device.written, 0.4, 1e-6) << describe(raised.servo->report().cause);
    limit = 3.3;
    Written coming;
    raised.run(1.0, goal, &coming);
    EXPECT_LT(coming.step, 0.1) << "no jump";
    expect_whole(raised, goal, "raised limit");

    Press warm(wall, 1000.0, light(), {.max_force = 2.0});
    std::uint32_t warnings = kDeviceWarm;
    warm.device.sensing = [&](DeviceSample& sample) {
      sample.warnings = warnings;
      return true;
    };
    warm.law = [&](DeviceModel& model) { model.max_force = 2.0; };
    const double less = -1.4 / 300.0;
    warm.until_active();
    warm.run(0.3, 0.004);
    warm.go(1.0, 0.004, -5.0 / 300.0);
    warm.run(0.5, -5.0 / 300.0);
    EXPECT_NEAR(warm.device.written, 1.0, 1e-6);
    warnings = 0;
    warm.run(0.5, less);
    expect_whole(warm, less, "warm no more");

    Press still(wall, 1000.0, light());
    still.device.sensing = [&](DeviceSample& sample) {
      sample.position.y = 1e-4 * std::round(sample.position.y / 1e-4);
      return true;
    };
    still.until_active();
    still.run(0.3, 0.004);
    const double held = -0.63 / 300.0;
    still.go(0.1, 0.004, held);
    still.run(1.0, held);
    // It moves on by more than a count, again and again: whole again within the ramp.
    for (int i = 0; i < 3; ++i) {
      still.go(0.02, held, held - 1e-3);
      still.go(0.02, held - 1e-3, held);
      for (int k = 0; k < 250; ++k) still.tick(held + 3e-4 * std::sin(0.2 * k));
      EXPECT_GT(still.device.written, 0.7 * std::max(0.0, -wall * still.hand.y)) << i;
      still.run(0.6, held);
    }
  }
}

// [J] Energy that a hand gets in six cycles of a force that is three times as large outwards as inwards, after
// `before`.
template <class F>
double energy_of_active_wall(F&& before) {
  Press press(400.0, 1000.0, {0.15, 5.0, 300.0, 0.004});
  const double goal = -2.5 / 300.0;
  press.until_active();
  press.run(0.3, 0.004);
  press.go(0.6, 0.004, goal);
  press.run(0.5, goal);
  before(press, goal);
  press.law = nullptr;
  press.go(0.3, goal, 0.004);
  press.run(0.3, 0.004);
  press.law = [&press](DeviceModel& model) {
    if (press.hand.v < 0.0) model.wrench.force.y /= 3.0, model.force_by_position[1][1] /= 3.0;
  };
  const double work = press.hand.work;
  for (int i = 0; i < 6; ++i) press.go(0.2, 0.004, goal), press.go(0.2, goal, 0.004);
  EXPECT_EQ(press.servo->state(), DeviceState::kActive) << describe(press.servo->report().cause);
  return press.hand.work - work;
}

// Each time the force comes back the hand is credited with what it would have stored against it, but once: neither a
// limit that goes down and up nor a pose that is lost and found fills the account.
TEST(SmoothForce, AForceThatGoesAndComesFillsNoAccount) {
  const double usual = energy_of_active_wall([](Press&, double) {});
  const double limited = energy_of_active_wall([](Press& press, double goal) {
    double limit = 3.3;
    press.law = [&limit](DeviceModel& model) { model.max_force = limit; };
    for (int i = 0; i < 20; ++i) {
      limit = i % 2 ? 3.3 : 0.5;
      press.run(0.5, goal);
    }
  });
  const double lost = energy_of_active_wall([](Press& press, double goal) {
    for (int i = 0; i < 8; ++i) {
      press.device.sensing = [](DeviceSample&) { return false; };
      press.run(0.02, goal);
      press.device.sensing = nullptr;
      // the gate opens where the force is small
      press.go(0.4, goal, 0.0);
      press.run(0.3, -0.1 / 400.0);
      press.go(0.4, 0.0, goal);
      press.run(0.3, goal);
    }
  });
  EXPECT_LT(limited, usual + 1e-3);
  EXPECT_LT(lost, usual + 1e-3);
}

// A surface that stiffens in contact does work that no hand has put in. The energy budget is used up, and the hand gets
// only as much force as it presses with, without switching.
TEST(SmoothForce, ASpentAccountIsFeltAsASmallerForceNotAsASwitchedOne) {
  for (const double rate : {1000.0, 4000.0})
    for (const double mass : {0.05, 0.2, 0.5}) {
      Press press(200.0, rate, {mass, 5.0, 300.0, 0.004});
      press.until_active();
      press.run(0.3, 0.004);
      const double goal = -0.63 / 300.0;
      press.go(0.1, 0.004, goal);
      press.run(1.0, goal);
      for (int i = 0; i < 300; ++i) press.wall = 200.0 + 2.0 * i, press.tick(goal);
      press.run(0.5, goal);
      Written written;
      press.run(0.5, goal, &written);
      EXPECT_EQ(written.zeros, 0) << rate << ' ' << mass;
      EXPECT_LT(written.step, 0.03) << rate << ' ' << mass;
      EXPECT_GT(written.mean, 0.3 * written.wanted) << rate << ' ' << mass;
      // The hand gets its own energy back, and the next press has the full force.
      press.go(0.2, goal, 0.004);
      press.go(0.2, 0.004, goal);
      press.run(1.0, goal);
      expect_whole(press, goal, "next press");
    }
}

}  // namespace
}  // namespace pliant
