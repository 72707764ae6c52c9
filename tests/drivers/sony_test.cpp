#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "devices/drivers/motion_filter.h"
#include "devices/drivers/shaker.h"
#include "devices/drivers/sony_pad.h"
#include "scenes/count_allocations.h"
#include "tests/drivers/emulated_sony.h"

namespace pliant {
namespace {

using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

struct Line {
  SonyModel model;
  bool bluetooth;
};
const Line kLines[] = {{SonyModel::kDualSense, false},
                       {SonyModel::kDualSense, true},
                       {SonyModel::kDualShock, false},
                       {SonyModel::kDualShock, true}};

// One driver on one emulated controller that reports every 4 ms.
struct SonyRig {
  explicit SonyRig(const Line& line, const std::string& id = "", int firmware = 0x0220)
      : pad(line.model, line.bluetooth, firmware),
        driver(make_sony_pad(line.model, opener_of(pad.hid), clock.function())) {
    EXPECT_TRUE(driver->open(id).ok());
  }
  DeviceSample hold(const EmulatedHold& hold, int milliseconds, const std::function<void(int)>& disturb = {}) {
    DeviceSample sample;
    for (int i = 0; i < milliseconds; ++i) {
      if (i % 4 == 0) pad.hold(hold, 0.004);
      if (disturb) disturb(i);
      clock.now += 0.001;
      EXPECT_TRUE(driver->read(sample));
    }
    return sample;
  }
  void push(const DeviceWrench& wrench, int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) {
      clock.now += 0.001;
      driver->write(wrench);
    }
  }
  EmulatedClock clock;
  EmulatedSony pad;
  std::unique_ptr<Driver> driver;
};

double angle_between(const dquat& a, const dquat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

TEST(Sony, TheSumIsTheCrcOfTheStandardsCheckValue) {
  const std::string digits = "23456789";
  EXPECT_EQ(sony_crc('1', std::span(reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size())), 0xcbf43926u);
}

TEST(Sony, SticksTriggersAndButtonsArriveOnEveryLine) {
  for (const Line& line : kLines) {
    SonyRig rig(line, "?dead_zone=0");
    EmulatedHold hold;
    hold.sticks = {1.0, -1.0, 0.0, -1.0};  // left: right and away; right: up
    hold.right = 0.6;
    hold.buttons = {static_cast<std::uint8_t>(0x20 | 3), 0x22, 0x01};  // cross, hat right and down; R1, R3... home
    const DeviceSample sample = rig.hold(hold, 300);
    EXPECT_GT(sample.position.x, 0.025);
    EXPECT_NEAR(sample.position.y, sample.position.x, 1e-4);
    EXPECT_NEAR(sample.position.z, -sample.position.x, 1e-4);
    EXPECT_NEAR(sample.grip, 0.6, 1e-9);
    EXPECT_EQ(sample.buttons, kCross | kHatRight | kHatDown | kRightShoulder | kOptions | kHome);
  }
}

TEST(Sony, AQuarterTurnOfTheGyroscopeIsAQuarterTurnOfThePoseAboutEachAxis) {
  for (const Line& line : kLines)
    for (int axis = 0; axis < 3; ++axis) {
      SonyRig rig(line);
      EmulatedHold hold;
      rig.hold(hold, 100);
      dvec3 about(0);
      about[axis] = 1.0;
      // Gravity rotates with it, as in a hand.
      for (int i = 0; i < 250; ++i) {
        hold.turning = 90.0 * kDegree * about;
        const dquat now = glm::angleAxis(90.0 * kDegree * (i + 1) / 250.0, about);
        hold.felt = glm::conjugate(now) * dvec3(0, 9.80665, 0);
        rig.hold(hold, 4);
      }
      hold.turning = dvec3(0);
      EXPECT_LT(angle_between(rig.hold(hold, 8).rotation, glm::angleAxis(90.0 * kDegree, about)), 0.5 * kDegree)
          << axis << (line.model == SonyModel::kDualSense) << line.bluetooth;
    }
}

TEST(Sony, TheSameReportTwiceTurnsOnce) {
  for (const Line& line : kLines) {
    SonyRig once(line), twice(line);
    EmulatedHold hold;
    hold.turning = {0, 1.0, 0};
    const DeviceSample expected = once.hold(hold, 400);
    EmulatedHid& hid = twice.pad.hid;
    const DeviceSample found = twice.hold(hold, 400, [&](int i) {
      if (i % 4 == 0) hid.say(hid.waiting.back().view());
    });
    EXPECT_EQ(expected.rotation, found.rotation);
  }
}

TEST(Sony, BrokenReportsChangeNothing) {
  for (const Line& line : kLines) {
    SonyRig clean(line), disturbed(line);
    EmulatedHold hold;
    hold.sticks[0] = 0.7;
    hold.turning = {0.3, -0.2, 0.1};
    const DeviceSample expected = clean.hold(hold, 400);
    EmulatedHold other;
    other.sticks = {-1, -1, -1, -1};
    EmulatedSony stranger(line.model, line.bluetooth);
    stranger.hid.on_feature(5);
    EmulatedHid& hid = disturbed.pad.hid;
    const DeviceSample found = disturbed.hold(hold, 400, [&](int i) {
      std::vector<std::uint8_t> report = stranger.report(other, 0.004);
      if (i % 3 == 0) hid.say(std::span(report).first(report.size() - 1));  // short
      if (i % 3 == 1 && line.bluetooth) report[20] ^= 4, hid.say(report);   // a bit fell over
      if (i % 3 == 2) report[0] = 0x77, hid.say(report);                    // another's number
      hid.say({});
    });
    EXPECT_EQ(found.position, expected.position);
    EXPECT_EQ(found.rotation, expected.rotation);
  }
}

TEST(Sony, EveryWrongBitOfABluetoothReportIsFound) {
  for (const SonyModel model : {SonyModel::kDualSense, SonyModel::kDualShock}) {
    EmulatedSony pad(model, true);
    pad.hid.on_feature(5);
    std::vector<std::uint8_t> report = pad.report({}, 0.004);
    SonyInput input;
    EXPECT_EQ(parse_sony(model, true, report, input), SonyParse::kSample);
    for (std::size_t bit = 8; bit < 8 * report.size(); ++bit) {
      report[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
      EXPECT_EQ(parse_sony(model, true, report, input), SonyParse::kCorrupt) << bit;
      report[bit / 8] ^= static_cast<std::uint8_t>(1 << bit % 8);
    }
  }
}

TEST(Sony, ByBluetoothItIsAskedForItsWholeReport) {
  for (const SonyModel model : {SonyModel::kDualSense, SonyModel::kDualShock}) {
    EmulatedSony pad(model, true);
    EXPECT_EQ(pad.report({}, 0.0).size(), 10u) << "an emulation that needs no asking proves nothing";
    const std::unique_ptr<Driver> driver = make_sony_pad(model, opener_of(pad.hid));
    ASSERT_TRUE(driver->open("").ok());
    EXPECT_EQ(pad.report({}, 0.0).size(), 78u);
  }
}

TEST(Sony, AControllerWithoutCalibrationTurnsAsItsPartsNominallyDo) {
  for (const Line& line : kLines) {
    EmulatedSony pad(line.model, line.bluetooth);
    for (auto& [number, report] : pad.hid.features)
      if (number != 0x20) std::fill(report.begin() + 1, report.end(), std::uint8_t(0));
    EXPECT_FALSE(parse_sony_calibration(line.model, line.bluetooth, pad.hid.features.begin()->second));
    EXPECT_TRUE(make_sony_pad(line.model, opener_of(pad.hid))->open("").ok());
  }
}

TEST(Sony, BatteryIsReadOnEveryLine) {
  for (const Line& line : kLines) {
    EmulatedSony pad(line.model, line.bluetooth);
    pad.hid.on_feature(5);
    SonyInput input;
    ASSERT_EQ(parse_sony(line.model, line.bluetooth, pad.report({}, 0.0), input), SonyParse::kSample);
    EXPECT_NEAR(input.battery, 0.7, 1e-9);
    EXPECT_EQ(input.charging, line.model == SonyModel::kDualShock);
  }
}

TEST(Sony, AForceShakesAndNoForceEndsItAtOnce) {
  for (const Line& line : kLines)
    for (const int firmware : {0x0200, 0x0220}) {
      SonyRig rig(line, "", firmware);
      rig.push({.force = {0, 3.0, 0}}, 12);
      EXPECT_GT(rig.pad.weak, 150);  // the blow of the contact
      rig.push({.force = {0, 3.0, 0}}, 500);
      EXPECT_LT(rig.pad.weak, 3);
      EXPECT_NEAR(rig.pad.strong, 255 * Shaker::kPressed, 2);
      const std::size_t before = rig.pad.hid.heard.size();
      rig.push({}, 1);
      EXPECT_EQ(rig.pad.strong, 0);
      EXPECT_EQ(rig.pad.hid.heard.size(), before + 1);
      rig.push({}, 1000);
      EXPECT_EQ(rig.pad.hid.heard.size(), before + 1) << "nothing new, nothing sent";
      rig.push({.force = {std::nan(""), 0, 0}}, 20);
      EXPECT_EQ(rig.pad.strong + rig.pad.weak, 0);
      EXPECT_EQ(rig.pad.refused, 0);
    }
}

TEST(Sony, AForceThatChangesAlwaysIsSentNoOftenerThanTheMotorsFollow) {
  SonyRig rig(kLines[1]);
  for (int i = 0; i < 1000; ++i) rig.push({.force = {0.001 * i, 1.0 + std::sin(0.3 * i), 0}}, 1);
  EXPECT_LE(rig.pad.hid.heard.size(), 101u);
  EXPECT_GT(rig.pad.hid.heard.size(), 60u);
  EXPECT_EQ(rig.pad.refused, 0);
}

TEST(Sony, TheTriggerResistsMoreTheMoreIsWantedAndNotAtAllAtTheEnd) {
  for (const bool bluetooth : {false, true}) {
    SonyRig rig({SonyModel::kDualSense, bluetooth});
    int last = 0;
    for (const double grip : {0.2, 1.0, 2.2, 3.1, 4.0, 40.0}) {
      rig.push({.grip = grip}, 15);
      EXPECT_GE(rig.pad.resistance, last);
      last = rig.pad.resistance;
    }
    EXPECT_EQ(last, 8);
    rig.push({.grip = std::nan("")}, 15);
    EXPECT_EQ(rig.pad.resistance, 0);
    rig.push({.grip = 4.0}, 15);
    rig.driver->make_safe();
    EXPECT_EQ(rig.pad.resistance, 0);
    rig.push({.grip = 4.0}, 15);
    rig.driver->close();
    EXPECT_EQ(rig.pad.resistance, 0);
    EXPECT_EQ(rig.pad.refused, 0);
  }
}

TEST(Sony, SilentOrUnpluggedItHasNoSample) {
  for (const Line& line : kLines) {
    SonyRig rig(line);
    DeviceSample sample;
    EXPECT_FALSE(rig.driver->read(sample)) << "before its first report";
    rig.hold({}, 20);
    for (int i = 0; i < 60; ++i) rig.clock.now += 0.001, (void)rig.driver->read(sample);
    EXPECT_FALSE(rig.driver->read(sample));
    rig.hold({}, 20);  // heard again
    rig.pad.hid.unplugged = true;
    EXPECT_FALSE(rig.driver->read(sample));
    rig.push({.force = {1, 0, 0}}, 5);
    rig.driver->close();
  }
}

TEST(Sony, ReadingAndWritingDoNotAllocate) {
  SonyRig rig(kLines[1]);
  for (int i = 0; i < 200; ++i) rig.pad.hold({}, 0.004);
  DeviceSample sample;
  const CountAllocations count;
  for (int i = 0; i < 400; ++i) {
    rig.clock.now += 0.001;
    (void)rig.driver->read(sample);
    rig.driver->write({.force = {0.01 * i, 0, 0}, .grip = 0.01 * i});
  }
  EXPECT_EQ(count.count(), 0u);
}

TEST(MotionFilter, GravityRightsATiltAndARestingBiasIsLearned) {
  MotionFilter filter;
  const dquat tilted = glm::angleAxis(0.5, glm::normalize(dvec3(1, 0, 0.5)));
  filter.step(dvec3(0), dvec3(0, 9.80665, 0), 0.004);  // believes to lie flat
  const dvec3 felt = glm::conjugate(tilted) * dvec3(0, 9.80665, 0), bias(0.01, -0.015, 0.008);
  for (int i = 0; i < 10000; ++i) filter.step(bias, felt, 0.004);
  EXPECT_LT(length(filter.rotation() * (felt / length(felt)) - dvec3(0, 1, 0)), 1e-3);
  EXPECT_LT(length(filter.bias() - bias), 1e-4);
  const dquat before = filter.rotation();
  for (int i = 0; i < 10000; ++i) filter.step(bias, felt, 0.004);
  EXPECT_LT(angle_between(before, filter.rotation()), 1e-3) << "40 s at rest";
}

TEST(MotionFilter, NumbersThatAreNoneAreLeftOut) {
  MotionFilter filter;
  filter.step(dvec3(0), dvec3(0, 9.8, 0), 0.004);
  const dquat before = filter.rotation();
  filter.step(dvec3(std::nan("")), dvec3(0, 9.8, 0), 0.004);
  filter.step(dvec3(1), dvec3(std::numeric_limits<double>::infinity()), 0.004);
  EXPECT_EQ(before, filter.rotation());
}

}  // namespace
}  // namespace pliant
