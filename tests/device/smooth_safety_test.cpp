// What the safety layer of the touch tick writes to a device without a rate, judged as a force: no hand that is in what
// it touches is to feel a force that is switched. Over a grid of hands, walls, presses and moments.
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "scenes/exact_hand.h"
#include "scenes/scenes.h"
#include "scenes/touch_laws.h"
#include "systems/device/softening.h"
#include "systems/safety/safety.h"

namespace pliant {
namespace {

constexpr double kDt = 1e-3;  // [s]

// A wall below y = 0, whose force goes through the layer in every tick.
struct SafePress {
  double wall = 400.0;
  ExactHand hand;
  HapticDevice device;
  SafetyState state;
  double time = 0.0, sent = 0.0, deepest = 0.0;
  double sampled = 0.0;  // [J] that sampling a spring gives: stable_stiffness()'s business

  SafePress(double stiffness, const ExactHand& who) : wall(stiffness), hand(who) {
    device.driver = DriverKind::kExternal;
  }
  double whole() const { return std::max(0.0, -wall * hand.y); }

  void tick(double wants, Written* written = nullptr) {
    time += kDt;
    device.sensed_at = time;
    SafetyLimits limits = force_limits(device);
    limits.touched = wall;
    const double before = sent, wanted = std::min(device.max_force, whole());
    sent = make_safe(state, device, limits, {0, whole(), 0}, {0, hand.y, 0}, time, kDt).force.y;
    if (written) written->add(sent, before, wanted, 0.02);
    hand.step(sent, wants, kDt);
    deepest = std::max(deepest, -hand.y);
    if (hand.y < 0.0) sampled += 0.5 * wall * kDt * hand.v * hand.v * kDt;
  }
  void run(double seconds, double wants, Written* written = nullptr) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kDt)); ++i) tick(wants, written);
  }
  void go(double seconds, double from, double to) {
    const int ticks = static_cast<int>(std::lround(seconds / kDt));
    for (int i = 1; i <= ticks; ++i) tick(from + (to - from) * i / ticks);
  }
};

constexpr double kAir = 0.004;  // [m]

// Every hand that comes to rest in this wall without a layer, too: the law itself is not in question.
int for_hands(const std::function<void(SafePress&, double goal, double seconds, const std::string& who)>& judge) {
  int hands = 0;
  for (const double mass : {0.05, 0.15, 0.5})
    for (const double damping : {1.0, 5.0})
      for (const double stiffness : {100.0, 300.0})
        for (const double wall : {200.0, 400.0, 1000.0})
          for (const double push : {0.63, 2.0})
            for (const double seconds : {0.02, 0.04, 0.08, 0.2}) {
              if ((damping - 0.5 * wall * kDt) / (2.0 * mass) < 2.0) continue;
              SafePress press(wall, {mass, damping, stiffness, kAir});
              ++hands;
              judge(press, -push / stiffness, seconds,
                    testing::PrintToString(std::array{mass, damping, stiffness, wall, push, seconds}));
            }
  return hands;
}

Written at_rest(SafePress& press, double goal) {
  press.run(2.0, goal);
  Written written;
  press.run(0.25, goal, &written);
  return written;
}

void expect_smooth(const Written& written, const std::string& who) {
  EXPECT_EQ(written.zeros, 0) << who;
  EXPECT_LT(written.step, 0.02) << who;
}

TEST(SmoothSafety, AHandThatComesIntoAWallFeelsAllOfIt) {
  const int hands = for_hands([](SafePress& press, double goal, double seconds, const std::string& who) {
    press.run(0.1, kAir);
    press.go(seconds, kAir, goal);
    const Written written = at_rest(press, goal);
    expect_smooth(written, who);
    EXPECT_NEAR(written.mean / written.wanted, 1.0, 1e-6) << who;
    press.go(0.3, goal, kAir);
    EXPECT_LT(press.hand.work, 1.2 * press.sampled + 5e-6) << who;
  });
  EXPECT_GE(hands, 200);
}

// The gate lets a force below 0.2 N in at once: a hand that then rests shallower got it back without having given it.
TEST(SmoothSafety, AGateThatOpensInContactIsPaidForAndTheForceStaysWhole) {
  for_hands([](SafePress& press, double goal, double seconds, const std::string& who) {
    press.hand.y = -0.19 / press.wall;
    press.go(seconds, press.hand.y, goal);
    press.run(1.0, goal);
    const double shallow = -0.1 * (1.0 / press.wall + 1.0 / press.hand.stiffness);
    press.go(0.2, goal, shallow);
    const Written written = at_rest(press, shallow);
    expect_smooth(written, who);
    EXPECT_NEAR(written.mean / written.wanted, 1.0, 1e-6) << who;
    // What it had in store as the gate opened, and no more.
    press.go(0.3, shallow, kAir);
    EXPECT_LT(press.hand.work, 0.5 * 0.19 * 0.19 / press.wall + 1.2 * press.sampled + 5e-6) << who;
  });
}

TEST(SmoothSafety, ALimitThatIsRaisedUnderAHandComesInSlowlyAndWhole) {
  for_hands([](SafePress& press, double goal, double seconds, const std::string& who) {
    press.device.max_force = 0.3;
    press.run(0.1, kAir);
    press.go(seconds, kAir, goal);
    press.run(1.0, goal);
    press.device.max_force = 3.3;
    for (int i = 1; i <= 300; ++i) {
      press.tick(goal);
      EXPECT_LE(press.sent, 0.3 + 3.3 * kDt / kRaise * i + 1e-9) << who;
    }
    const Written written = at_rest(press, goal);
    expect_smooth(written, who);
    EXPECT_NEAR(written.mean / written.wanted, 1.0, 1e-6) << who;
    const double most = 0.5 * press.wall * press.deepest * press.deepest;
    press.go(0.3, goal, kAir);
    EXPECT_LT(press.hand.work, most + 1.2 * press.sampled + 5e-6) << who;
  });
}

// A level's limit of stiffness: a spring of it, in and out, as long as the wall is stiffer.
TEST(SmoothSafety, AStiffnessLimitIsASofterSpringAndNoEngine) {
  for_hands([](SafePress& press, double goal, double seconds, const std::string& who) {
    press.device.max_stiffness = 0.5 * press.wall;
    press.run(0.1, kAir);
    press.go(seconds, kAir, goal);
    expect_smooth(at_rest(press, goal), who);
    EXPECT_LT(press.sent, press.device.max_stiffness * press.deepest + 1e-9) << who;
    for (int i = 0; i < 3; ++i) press.go(0.2, goal, kAir), press.go(0.2, kAir, goal);
    press.go(0.3, goal, kAir);
    EXPECT_LT(press.hand.work, 1.2 * press.sampled + 5e-6) << who;
  });
}

// Energy that no hand has given: a surface that stiffens under a hand, a force that comes in late. It is felt as a smaller
// force, and the next press is whole.
TEST(SmoothSafety, ASpentAccountIsFeltAsASmallerForceNotAsASwitchedOne) {
  for_hands([](SafePress& press, double goal, double seconds, const std::string& who) {
    press.run(0.1, kAir);
    press.wall = 200.0;
    press.go(seconds, kAir, goal);
    press.run(1.0, goal);
    for (int i = 0; i < 300; ++i) press.wall = 200.0 + 2.0 * i, press.tick(goal);
    const Written written = at_rest(press, goal);
    EXPECT_EQ(written.zeros, 0) << who;
    EXPECT_LT(written.step, 0.03) << who;
    EXPECT_GT(written.mean, 0.3 * written.wanted) << who;
  });
  for_hands([](SafePress& press, double goal, double seconds, const std::string& who) {
    press.device.max_slew = 200.0;
    press.run(0.1, kAir);
    press.go(seconds, kAir, goal);
    const Written written = at_rest(press, goal);
    EXPECT_EQ(written.zeros, 0) << who;
    EXPECT_LT(written.step, 0.03) << who;
    press.go(0.3, goal, kAir);
    EXPECT_LT(press.hand.work, 1.2 * press.sampled + 1e-4) << who;
  });
}

// A softening law is nearly flat where it is pressed deep: its slope there says little of the energy that the hand
// gave.
TEST(SmoothSafety, ARaisedLimitCreditsNoMoreThanTheHandGaveToASofteningLaw) {
  for (const double softening : {-300.0, -1000.0, -2000.0})
    for (const double depth : {0.001, 0.004}) {
      scenes::Stage stage;
      Deformable surface = frictionless(SpringLaw::kExponential);
      surface.stiffening = softening;
      stage.add(scenes::sheet(20, 0.2), surface);
      const Entity probe = stage.add_probe({0, 0.002, 0});
      stage.prepare();
      stage.device(probe).max_force = 0.05;
      stage.move(probe, {0, -depth, 0}, 0.1);
      stage.device(probe).max_force = 10.0;
      stage.wait(0.5);
      const double alpha = surface.stiffening,
                   energy = surface.stiffness / alpha * (std::expm1(alpha * depth) / alpha - depth);  // integral of F
      const SafetyState& state = *safety_of(stage.world, probe);
      EXPECT_NEAR(stage.read(probe).force.y, law(surface, depth), 1e-6) << softening << ' ' << depth;
      EXPECT_LE(state.stored, energy * (1 + 1e-3)) << softening << ' ' << depth;
      EXPECT_GT(state.stored, 0.2 * energy) << softening << ' ' << depth;
    }
}

// The hand rests in a surface, while its device is lost and found again, or its limit goes down and up.
TEST(SmoothSafety, AForceThatIsTakenAwayAndComesBackIsCreditedOnce) {
  for (const bool lost : {true, false}) {
    scenes::Stage stage;
    const Deformable surface = frictionless();
    stage.add(scenes::sheet(20, 0.2), surface);
    const Entity probe = stage.add_probe({0, 0.002, 0});
    stage.prepare();
    const double depth = 0.15 / surface.stiffness;  // below the gate's force
    stage.move(probe, {0, -depth, 0}, 0.1);
    for (int i = 0; i < 50; ++i) {
      HapticDevice& device = stage.device(probe);
      if (lost)
        device.status = DeviceStatus::kLost;
      else
        device.max_force = 0.01;
      stage.tick();
      stage.device(probe).status = DeviceStatus::kReady;
      stage.device(probe).max_force = 10.0;
      stage.wait(0.25);
    }
    EXPECT_NEAR(stage.read(probe).force.y, 0.15, 1e-6) << lost;
    const SafetyState& state = *safety_of(stage.world, probe);
    EXPECT_LE(state.stored, 0.5 * 0.15 * depth * (1 + 1e-3)) << lost;
    EXPECT_GT(-state.work, 0.4 * 0.15 * depth) << lost << ": it can be given back";
  }
}

}  // namespace
}  // namespace pliant
