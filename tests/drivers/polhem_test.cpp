#include "devices/drivers/polhem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "scenes/count_allocations.h"
#include "tests/drivers/emulated_polhem.h"

namespace pliant {
namespace {

using testing::HasSubstr;

struct RandomBytes {
  std::mt19937 engine{7};
  double in(double least, double most) { return std::uniform_real_distribution(least, most)(engine); }
  // Within the arm's reach, away from where the linkage is stretched out.
  dvec3 angles() { return {in(-1.0, 1.0), in(-0.4, 0.9), in(0.4, 2.2)}; }
  dvec3 vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
};

TEST(PolhemKinematics, ParkedTheUpperArmIsUprightAndTheForearmLevel) {
  for (const char* name : {"polhem_v1", "woodenhaptics_v2015"})
    for (const PolhemConfig& config : kPolhemConfigs) {
      if (config.name != std::string(name)) continue;
      const dvec3 angles = EmulatedPolhem(config).parked();
      EXPECT_NEAR(angles.y, 0.0, 1e-9);
      EXPECT_NEAR(angles.z, std::numbers::pi / 2, 1e-3);
      const dvec3 tip = polhem_position(config, angles);
      EXPECT_NEAR(tip.z, config.lc - config.origin.x, 1e-5);              // towards the user: the forearm's length
      EXPECT_NEAR(tip.y, config.la + config.lb - config.origin.z, 1e-5);  // up: both others'
      EXPECT_NEAR(tip.x, 0.0, 1e-9);
    }
}

TEST(PolhemKinematics, BodyATurnsTheTipAboutTheVerticalToTheRight) {
  const PolhemConfig& config = kPolhemConfigs[0];
  const dvec3 ahead = polhem_position(config, {0.0, 0.2, 1.2}), aside = polhem_position(config, {0.3, 0.2, 1.2});
  EXPECT_GT(aside.x, ahead.x);
  EXPECT_EQ(aside.y, ahead.y);
}

TEST(PolhemKinematics, TheJacobianIsTheFiniteDifferenceOfThePosition) {
  RandomBytes random;
  for (const PolhemConfig& config : kPolhemConfigs)
    for (int i = 0; i < 50; ++i) {
      const dvec3 q = random.angles();
      const dmat3 jacobian = polhem_jacobian(config, q);
      for (int column = 0; column < 3; ++column) {
        dvec3 step(0);
        step[column] = 1e-5;
        const dvec3 difference = (polhem_position(config, q + step) - polhem_position(config, q - step)) / 2e-5;
        EXPECT_LT(length(jacobian[column] - difference), 1e-9) << config.name;
      }
    }
}

TEST(PolhemKinematics, TheMotorsPowerIsTheForcesPower) {
  RandomBytes random;
  for (const PolhemConfig& config : kPolhemConfigs)
    for (int i = 0; i < 50; ++i) {
      const dvec3 q = random.angles(), rates = random.vector(0.5), force = random.vector(0.5);
      const double h = 1e-5;
      const dvec3 velocity =
          (polhem_position(config, q + h * rates) - polhem_position(config, q - h * rates)) / (2 * h);
      // Motor power: torque constant x current x the motor's own speed, from the encoders' definition.
      const dvec3 motor_rates = rates * config.body / config.capstan * config.sign;
      const double electric = dot(polhem_currents(config, q, force) * config.torque_constant, motor_rates);
      EXPECT_NEAR(electric, dot(force, velocity), 1e-9) << config.name;
    }
}

TEST(PolhemKinematics, AboveTheLimitAllMotorsAreScaledAndTheDirectionStays) {
  RandomBytes random;
  int saturated = 0;
  for (const PolhemConfig& config : kPolhemConfigs)
    for (int i = 0; i < 50; ++i) {
      const dvec3 q = random.angles(), force = random.vector(200.0);
      const dvec3 currents = polhem_currents(config, q, force), rendered = polhem_force(config, q, currents);
      for (int motor = 0; motor < 3; ++motor) EXPECT_LE(std::abs(currents[motor]), config.max_current * (1 + 1e-12));
      EXPECT_LT(length(cross(rendered, force)), 1e-6 * length(rendered) * length(force));
      EXPECT_GT(dot(rendered, force), 0.0);
      if (length(rendered) < 0.99 * length(force)) ++saturated;
      EXPECT_LE(length(rendered), length(force) * (1 + 1e-9));
    }
  EXPECT_GT(saturated, 50);
}

TEST(PolhemKinematics, AForceThatIsNotFiniteIsNoCurrent) {
  EXPECT_EQ(polhem_currents(kPolhemConfigs[0], {0, 0.2, 1}, {std::nan(""), 0, 1}), dvec3(0));
  EXPECT_EQ(polhem_currents(kPolhemConfigs[0], {0, 0.2, 1}, {0, std::numeric_limits<double>::infinity(), 1}), dvec3(0));
}

TEST(PolhemKinematics, TheGimbalTurnsThePenAboutTheForearm) {
  const PolhemConfig& config = kPolhemConfigs[0];
  // Forearm level towards the user: the first joint turns about the world's z, by a quarter turn for 256 counts.
  std::array<std::int16_t, 6> counts{0, 0, -5000, 0, 0, 0};
  const dquat before = polhem_pose(config, counts).rotation;
  counts[3] = static_cast<std::int16_t>(256 * config.turn_sign.x);
  const dquat turned = polhem_pose(config, counts).rotation * glm::conjugate(before);
  EXPECT_GT(std::abs(glm::dot(turned, glm::angleAxis(std::numbers::pi / 2, dvec3(0, 0, 1)))), 1 - 1e-9);
}

// A driver on an emulated arm, ticked as the servo of a device does: wait, read, write.
struct PolhemRig {
  explicit PolhemRig(const std::string& words, const PolhemConfig& config = kPolhemConfigs[0])
      : arm(config), driver(make_polhem(opener_of(arm.hid), clock.function())) {
    opened = driver->open("?mechanism=" + std::string(config.name) + words);
  }
  bool tick(const DeviceWrench& wrench = {}) {
    clock.now += 0.001;
    arm.pass(0.001);
    driver->wait(0.001);
    const bool read = driver->read(sample);
    driver->write(wrench);
    return read;
  }
  EmulatedClock clock;
  EmulatedPolhem arm;
  std::unique_ptr<Driver> driver;
  Status opened = Done{};
  DeviceSample sample;
};

TEST(Polhem, AZeroReportStartsItAndEveryReportIsAnswered) {
  PolhemRig rig("&home=kept");
  ASSERT_TRUE(rig.opened.ok());
  EXPECT_EQ(rig.driver->capabilities().loop, DeviceLoop::kReply);
  ASSERT_EQ(rig.arm.hid.heard.size(), 1u);
  for (const std::uint8_t byte : rig.arm.hid.heard[0].view()) EXPECT_EQ(byte, 0);
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(rig.tick());
  EXPECT_EQ(rig.arm.hid.heard.size(), 101u);
  EXPECT_EQ(rig.arm.refused, 0);
}

TEST(Polhem, ItDoesNotOpenWithoutItsMechanism) {
  EmulatedPolhem arm(kPolhemConfigs[0]);
  const auto error = [&](const char* id) { return make_polhem(opener_of(arm.hid))->open(id).error().message(); };
  EXPECT_THAT(error(""), HasSubstr("cannot say which build it is"));
  EXPECT_THAT(error("?mechanism=polhem_v2"), HasSubstr("NAME one of polhem_v1, woodenhaptics_v2015"));
  EXPECT_THAT(error("?mechanism=polhem_v1&home=away"), HasSubstr("must be one of button, here, kept"));
  EXPECT_TRUE(arm.hid.heard.empty());
}

TEST(Polhem, UntilItsButtonIsPressedThePoseIsUnknownAndNoForceLeaves) {
  PolhemRig rig("");
  for (int i = 0; i < 50; ++i) {
    EXPECT_TRUE(rig.tick({.force = {3, 3, 3}}));
    EXPECT_FALSE(rig.sample.ready);
    EXPECT_EQ(rig.arm.currents, dvec3(0));
  }
  rig.arm.press_button();
  for (int i = 0; i < 5; ++i) rig.tick();
  EXPECT_TRUE(rig.sample.ready);
  EXPECT_LT(length(rig.sample.position - polhem_position(kPolhemConfigs[0], rig.arm.angles)), 1e-3);
  rig.tick({.force = {1, 0, 0}});
  EXPECT_GT(length(rig.arm.currents), 0.0);
}

TEST(Polhem, ParkedWhenOpenedItIsReadyAtOnce) {
  for (const PolhemConfig& config : kPolhemConfigs) {
    PolhemRig rig("&home=here", config);
    for (int i = 0; i < 5; ++i) rig.tick();
    EXPECT_TRUE(rig.sample.ready) << config.name;
  }
}

TEST(Polhem, TheForceThatTheArmRendersIsTheForceThatWasWritten) {
  for (const PolhemConfig& config : kPolhemConfigs) {
    RandomBytes random;
    PolhemRig rig("&home=here", config);
    for (int i = 0; i < 5; ++i) rig.tick();
    dvec3 at = rig.arm.angles;
    for (int goal = 0; goal < 20; ++goal) {
      const dvec3 to = random.angles(), force = random.vector(0.4), from = at;
      for (int i = 1; i <= 200; ++i) {
        at = from + (to - from) * (i / 200.0);
        rig.arm.move(at);
        ASSERT_TRUE(rig.tick({.force = force}));
        ASSERT_TRUE(rig.sample.ready);
      }
      rig.tick({.force = force});
      rig.tick({.force = force});
      EXPECT_LT(length(rig.sample.position - polhem_position(config, at)), 4e-4) << config.name;  // error of a whole
                                                                                                  // count
      const dvec3 rendered = polhem_force(config, at, rig.arm.currents);
      EXPECT_LT(length(rendered - force), 0.05) << config.name;  // error of a whole milliampere, and of the count
    }
  }
}

TEST(Polhem, PenButtonAndGimbalAreDistinguished) {
  PolhemInput input;
  EmulatedPolhem arm(kPolhemConfigs[0]);
  arm.turn = {-900, 20, 30};
  arm.pen_button = true;
  arm.answer();
  ASSERT_TRUE(parse_polhem(arm.hid.waiting.back().view(), input));
  EXPECT_TRUE(input.button);
  EXPECT_EQ(input.counts[3], -900);
  EXPECT_EQ(input.counts[4], 20);
  EXPECT_FALSE(parse_polhem(arm.hid.waiting.back().view().first(13), input));
}

TEST(Polhem, ShortRepeatedAndLeapingReportsDoNotMoveIt) {
  PolhemRig rig("&home=here");
  for (int i = 0; i < 10; ++i) rig.tick();
  const dvec3 at = rig.sample.position;
  for (int i = 0; i < 100; ++i) {
    if (i % 4 == 0) rig.arm.hid.say(std::array<std::uint8_t, 13>{1, 2, 3});
    if (i % 4 == 1) rig.arm.hid.say(rig.arm.hid.waiting.back().view());
    if (i % 4 == 2) rig.arm.hid.say(std::array<std::uint8_t, 64>{0xff, 0x6f, 0x11, 0x55, 0x01, 0x80});
    if (i % 4 == 3) rig.arm.hid.say({});
    if (rig.tick({.force = {0, 1, 0}})) EXPECT_EQ(rig.sample.position, at);
    EXPECT_TRUE(rig.sample.ready);
  }
}

TEST(Polhem, EncodersThatSomeoneElseHasSetAreNotBelieved) {
  PolhemRig rig("&home=here");
  for (int i = 0; i < 10; ++i) rig.tick({.force = {0, 1, 0}});
  EXPECT_GT(length(rig.arm.currents), 0.0);
  std::array<std::uint8_t, kPolhemOutput> reset;
  polhem_set_encoders({3000, -3000, 2000, 0, 0, 0}, reset);
  rig.arm.hid.on_packet(reset);
  for (int i = 0; i < 10; ++i) rig.tick({.force = {0, 1, 0}});
  EXPECT_FALSE(rig.sample.ready);
  EXPECT_EQ(rig.arm.currents, dvec3(0));
}

TEST(Polhem, APauseOfTheProgramIsNoLeap) {
  PolhemRig rig("&home=here");
  for (int i = 0; i < 10; ++i) rig.tick();
  rig.clock.now += 0.2;
  rig.arm.move(rig.arm.angles + dvec3(0.3, 0.2, -0.2));
  for (int i = 0; i < 3; ++i) rig.tick();
  EXPECT_TRUE(rig.sample.ready);
  EXPECT_LT(length(rig.sample.position - polhem_position(kPolhemConfigs[0], rig.arm.angles)), 4e-4);
}

TEST(Polhem, SilentTheArmSwitchesItsMotorsOffItself) {
  PolhemRig rig("&home=here");
  for (int i = 0; i < 10; ++i) rig.tick({.force = {0, 1, 0}});
  EXPECT_GT(length(rig.arm.currents), 0.0);
  for (int i = 0; i < 510; ++i) rig.arm.pass(0.001);
  EXPECT_EQ(rig.arm.currents, dvec3(0));
  EXPECT_FALSE(rig.arm.enabled);
}

TEST(Polhem, ClosedMadeSafeOrUnpluggedNoForceStays) {
  PolhemRig rig("&home=here");
  for (int i = 0; i < 10; ++i) rig.tick({.force = {0, 1, 0}});
  rig.driver->make_safe();
  EXPECT_EQ(rig.arm.currents, dvec3(0));
  rig.tick({.force = {0, 1, 0}});
  rig.driver->close();
  EXPECT_EQ(rig.arm.currents, dvec3(0));
  EXPECT_FALSE(rig.driver->read(rig.sample));
  ASSERT_TRUE(rig.driver->open("?mechanism=polhem_v1&home=kept").ok());
  rig.tick();
  rig.arm.hid.unplugged = true;
  EXPECT_FALSE(rig.tick({.force = {0, 1, 0}}));
  rig.driver->make_safe();
  rig.driver->close();
}

TEST(Polhem, ReadingAndWritingDoNotAllocate) {
  PolhemRig rig("&home=here");
  for (int i = 0; i < 10; ++i) rig.tick();
  const CountAllocations count;
  for (int i = 0; i < 100; ++i) rig.tick({.force = {0, 1, 0}});
  EXPECT_EQ(count.count(), 0u);
}

TEST(Polhem, CurrentsAreWholeMilliamperesAndNeverWrap) {
  std::array<std::uint8_t, kPolhemOutput> report;
  polhem_drive({1.2345, -100.0, std::nan("")}, report);
  const auto s16 = [&](std::size_t at) { return static_cast<std::int16_t>(report[at] | report[at + 1] << 8); };
  EXPECT_EQ(s16(1), 1234);
  EXPECT_EQ(s16(3), -32767);
  EXPECT_EQ(s16(5), 0);
}

}  // namespace
}  // namespace pliant
