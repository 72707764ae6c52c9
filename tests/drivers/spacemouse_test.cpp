#include "devices/drivers/spacemouse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/drivers/emulated_spacemouse.h"

namespace pliant {
namespace {

using testing::HasSubstr;

// One driver on one emulated cap, a thousand reads a second of simulated time.
struct SpacemouseRig {
  explicit SpacemouseRig(bool six_in_one = false, bool described = true, const std::string& id = "")
      : cap(six_in_one, described), driver(make_spacemouse(opener_of(cap.hid), clock.function())) {
    EXPECT_TRUE(driver->open(id).ok());
  }
  // Sends a report with these counts every 8 ms; `disturb` may add packets.
  DeviceSample hold(const std::array<int, 6>& counts, int milliseconds, const std::function<void(int)>& disturb = {}) {
    DeviceSample sample;
    for (int i = 0; i < milliseconds; ++i) {
      if (i % 8 == 0) cap.deflect(counts);
      if (disturb) disturb(i);
      clock.now += 0.001;
      EXPECT_TRUE(driver->read(sample));
    }
    return sample;
  }
  EmulatedClock clock;
  EmulatedSpaceMouse cap;
  std::unique_ptr<Driver> driver;
};

// Integral over `t` of a deflection low-passed with `smooth`.
double travelled(double speed, double smooth, double t) {
  return speed * (t + smooth * std::expm1(-t / smooth));
}

const dvec3 kWorldAxes[] = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};  // of the device's X, Y, Z

TEST(SpaceMouse, EveryAxisMovesAlongItsWorldAxisByRateOnEveryLayout) {
  const StickSettings usual;
  for (const auto& [six, described] : {std::pair{false, true}, {true, true}, {false, false}, {true, false}})
    for (std::size_t axis = 0; axis < 6; ++axis) {
      SpacemouseRig rig(six, described);
      std::array<int, 6> counts{};
      counts[axis] = 350;
      const DeviceSample sample = rig.hold(counts, 400);
      const dvec3 along = kWorldAxes[axis % 3];
      const dvec3 moved = axis < 3 ? travelled(usual.speed, usual.smooth, 0.4) * along : dvec3(0);
      EXPECT_LT(length(sample.position - moved), 2e-3 * usual.speed) << axis << six << described;
      const double angle = axis < 3 ? 0.0 : travelled(usual.turn, usual.smooth, 0.4);
      const dquat turned = glm::angleAxis(angle, along);
      EXPECT_GT(std::abs(glm::dot(sample.rotation, turned)), 1.0 - 1e-5) << axis << six << described;
    }
}

TEST(SpaceMouse, AnOppositePushUndoesAPush) {
  SpacemouseRig rig;
  rig.hold({200, -300, 100, 50, 150, -250}, 300);
  rig.hold({0, 0, 0, 0, 0, 0}, 600);
  rig.hold({-200, 300, -100, 0, 0, 0}, 300);
  EXPECT_LT(length(rig.hold({0, 0, 0, 0, 0, 0}, 600).position), 1e-9);
}

TEST(SpaceMouse, ByPositionTheCapIsADisplacementAndComesBack) {
  SpacemouseRig rig(false, true, "?control=position&reach=0.04&dead_zone=0");
  EXPECT_LT(length(rig.hold({175, 0, 0, 0, 0, 0}, 400).position - dvec3(0.02, 0, 0)), 1e-9);
  EXPECT_LT(length(rig.hold({0, 0, -350, 0, 0, 0}, 400).position - dvec3(0, 0.04, 0)), 1e-9);
  EXPECT_LT(length(rig.hold({0, 0, 0, 0, 0, 0}, 400).position), 1e-9);
}

TEST(SpaceMouse, TheWorkspaceEndsWhereItSays) {
  SpacemouseRig rig;
  const dvec3 extent = rig.driver->capabilities().workspace;
  EXPECT_EQ(rig.hold({350, -350, -350, 0, 0, 0}, 5000).position, dvec3(extent.x, extent.y, -extent.z));
}

TEST(SpaceMouse, TheClutchKeepsThePoseAndLetsItGoOnWithoutAJump) {
  for (const char* id : {"", "?control=position"}) {
    SpacemouseRig rig(false, true, id);
    const DeviceSample before = rig.hold({250, 0, 0, 0, 200, 0}, 300);
    rig.cap.press(2);
    DeviceSample last = rig.hold({250, 0, 0, 0, 200, 0}, 1);
    EXPECT_EQ(last.buttons, 2u);
    EXPECT_EQ(last.position, before.position);
    last = rig.hold({-100, 300, 0, 0, 0, 0}, 300);
    EXPECT_EQ(last.position, before.position) << id;
    EXPECT_EQ(last.rotation, before.rotation) << id;
    rig.cap.press(0);
    for (int i = 0; i < 100; ++i) {
      const DeviceSample now = rig.hold({-100, 300, 0, 0, 0, 0}, 1);
      EXPECT_LT(length(now.position - last.position), 1.1e-4 * 1.5) << id;  // motion of a millisecond at full speed
      last = now;
    }
  }
}

TEST(SpaceMouse, ADeadZoneIsContinuousAndKeepsFullScale) {
  for (const double zone : {0.0, 0.06, 0.5}) {
    EXPECT_EQ(without_dead_zone(zone, zone), 0.0);
    EXPECT_NEAR(without_dead_zone(zone + 1e-9, zone), 0.0, 1e-8);
    EXPECT_EQ(without_dead_zone(1.0, zone), 1.0);
    EXPECT_EQ(without_dead_zone(-3.0, zone), -1.0);
    EXPECT_EQ(without_dead_zone(std::nan(""), zone), 0.0);
  }
}

TEST(SpaceMouse, BrokenReportsChangeNothing) {
  SpacemouseRig clean, disturbed;
  const std::array<int, 6> counts{120, -80, 200, 30, -300, 60};
  const DeviceSample expected = clean.hold(counts, 500);
  const DeviceSample found = disturbed.hold(counts, 500, [&](int i) {
    EmulatedHid& hid = disturbed.cap.hid;
    if (i % 3 == 0) hid.say(std::array<std::uint8_t, 4>{1, 0xff, 0x7f, 0xff});            // short
    if (i % 4 == 0) hid.say(std::array<std::uint8_t, 7>{9, 1, 1, 1, 1, 1, 1});            // another's number
    if (i % 5 == 0) hid.say(std::array<std::uint8_t, 2>{0x17, 42});                       // battery
    if (i % 7 == 0) hid.say({});                                                          // none
    if (i % 8 == 0 && hid.waiting.size() > hid.next) hid.say(hid.waiting.back().view());  // twice
  });
  EXPECT_EQ(found.position, expected.position);
  EXPECT_EQ(found.rotation, expected.rotation);
}

TEST(SpaceMouse, CountsBeyondFullScaleAreFullScale) {
  SpacemouseRig within, beyond;
  EXPECT_EQ(within.hold({350, 0, 0, 0, 0, 0}, 200).position, beyond.hold({32767, 0, 0, 0, 0, 0}, 200).position);
}

TEST(SpaceMouse, ACapThatFallsSilentWhileDeflectedStops) {
  SpacemouseRig rig;
  rig.hold({350, 0, 0, 0, 0, 0}, 100);
  DeviceSample sample, later;
  for (int i = 0; i < 700; ++i) {
    rig.clock.now += 0.001;
    ASSERT_TRUE(rig.driver->read(sample));
  }
  for (int i = 0; i < 500; ++i) {
    rig.clock.now += 0.001;
    ASSERT_TRUE(rig.driver->read(later));
  }
  EXPECT_LT(length(later.position - sample.position), 1e-9);
  EXPECT_LT(sample.position.x, 0.10 * 0.5);  // long before the border
}

TEST(SpaceMouse, APauseOfTheProgramIsNotALeap) {
  SpacemouseRig rig;
  const DeviceSample before = rig.hold({350, 0, 0, 0, 0, 0}, 100);
  rig.clock.now += 30.0;
  DeviceSample after;
  ASSERT_TRUE(rig.driver->read(after));
  EXPECT_LT(length(after.position - before.position), 0.011);
}

TEST(SpaceMouse, UnpluggedItHasNoSampleAndIsOpenedAnewAtRest) {
  SpacemouseRig rig;
  rig.hold({350, 0, 0, 0, 0, 0}, 300);
  rig.cap.hid.unplugged = true;
  DeviceSample sample;
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(rig.driver->read(sample));
  EXPECT_FALSE(rig.driver->open("").ok());
  EXPECT_FALSE(rig.driver->read(sample));
  rig.cap.hid.unplugged = false;
  EXPECT_FALSE(rig.driver->read(sample)) << "a line that died stays dead";
  ASSERT_TRUE(rig.driver->open("").ok());
  EXPECT_EQ(rig.hold({0, 0, 0, 0, 0, 0}, 10).position, dvec3(0));
}

TEST(SpaceMouse, WordsThatItDoesNotKnowAreRefusedInOneSentence) {
  EmulatedSpaceMouse cap(false);
  const auto error = [&](const char* id) {
    const Status status = make_spacemouse(opener_of(cap.hid))->open(id);
    return status.ok() ? std::string("none") : status.error().message();
  };
  EXPECT_THAT(error("?mode=rate"), HasSubstr("unknown key 'mode'; keys are control, speed"));
  EXPECT_THAT(error("?control=both"), HasSubstr("must be one of rate, position; got 'both'"));
  EXPECT_THAT(error("?speed=fast"), HasSubstr("must be a number from 0.001 to 1; got 'fast'"));
  EXPECT_THAT(error("?speed=nan"), HasSubstr("got 'nan'"));
  EXPECT_THAT(error("?speed"), HasSubstr("is not KEY=VALUE"));
  EXPECT_THAT(error("?speed=0.1&speed=0.2"), HasSubstr("given twice"));
  EXPECT_EQ(error("serial?speed=0.2&control=position"), "none");
}

TEST(SpaceMouse, ADescriptorWithoutSixAxesIsRefused) {
  EmulatedSpaceMouse cap(false);
  cap.hid.descriptor = {0x05, 0x01, 0x09, 0x02, 0xa1, 0x01, 0x09, 0x30, 0x75, 0x08, 0x95, 0x01, 0x81, 0x06, 0xc0};
  EXPECT_THAT(make_spacemouse(opener_of(cap.hid))->open("").error().message(), HasSubstr("six axes"));
}

TEST(HidDescriptor, NamesEveryFieldOfACap) {
  const Result<HidLayout> layout = parse_hid_descriptor(spacemouse_descriptor(true));
  ASSERT_TRUE(layout.ok());
  EXPECT_TRUE(layout->numbered);
  EXPECT_THAT(layout->applications, testing::ElementsAre(8));
  EXPECT_EQ(layout->bytes(HidKind::kInput, 1), 13u);
  EXPECT_EQ(layout->bytes(HidKind::kInput, 3), 3u);
  EXPECT_EQ(layout->bytes(HidKind::kOutput, 4), 2u);
  EXPECT_EQ(layout->bytes(HidKind::kInput, 9), 0u);
  ASSERT_EQ(layout->fields.size(), 9u);  // six axes, two buttons, a lamp
  EXPECT_EQ(layout->fields[5].usage, 0x35);
  EXPECT_EQ(layout->fields[5].bit, 80u);
  EXPECT_EQ(layout->fields[5].min, -350);
  EXPECT_EQ(layout->fields[5].max, 350);
}

TEST(HidDescriptor, CutAnywhereItIsRefused) {
  const std::vector<std::uint8_t> whole = spacemouse_descriptor(false);
  for (std::size_t length = 1; length < whole.size(); ++length) {
    const Result<HidLayout> cut = parse_hid_descriptor(std::span(whole).first(length));
    EXPECT_EQ(cut.ok(), length == 2 || length == 4) << length;  // between items, before the first collection
  }
}

}  // namespace
}  // namespace pliant
