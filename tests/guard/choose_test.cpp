// Which device a request means.
#include "devices/choose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "devices/believable.h"

namespace pliant {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

DeviceInfo device(const char* driver, const char* id, double force, const char* missing = "") {
  DeviceInfo info{driver, id, std::string(driver) + " " + id, missing, {}};
  info.can.renders_force = force > 0.0;
  info.can.max_force = force;
  return info;
}

struct Choose : ::testing::Test {
  static void SetUpTestSuite() {
    for (const char* name : {"weak", "strong", "knob"}) (void)register_driver(name, [] { return nullptr; });
  }
  std::vector<DeviceInfo> there{device("weak", "1", 3.0), device("strong", "7", 8.0), device("strong", "8", 8.0),
                                device("knob", "", 0.0)};
};

TEST_F(Choose, TheStrongestThatPushesIsAnyForce) {
  const auto chosen = choose_device("any-force", there);
  ASSERT_TRUE(chosen) << chosen.error().message();
  EXPECT_EQ(chosen->id, "strong:7");
}

TEST_F(Choose, NoKindIsAStrangerOnAPortOrClaimsWhatCannotBe) {
  there.push_back(device("network", "127.0.0.1:17716", 1e9));
  there.push_back(device("weak", "boast", 1e9));
  for (const char* kind : {"any-force", "any"}) EXPECT_EQ(choose_device(kind, there)->id, "strong:7") << kind;
  const std::vector<DeviceInfo> alone{device("network", "127.0.0.1:17716", 5.0)};
  const auto none = choose_device("any-force", alone);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("by its name only: device:network:127.0.0.1:17716"));
  const auto boast = choose_device("any-force", std::vector<DeviceInfo>{device("weak", "boast", 1e9)});
  ASSERT_FALSE(boast);
  EXPECT_THAT(boast.error().message(), HasSubstr("says a largest force of 1e+09 N"));
}

TEST(Believable, LimitsAreFiniteAndOfAHapticDevice) {
  EXPECT_EQ(beyond_belief({.max_force = 8.0, .max_stiffness = 3000.0, .rate = 4000.0}), "");
  EXPECT_EQ(beyond_belief({}), "");
  EXPECT_THAT(beyond_belief({.max_force = 1e9}), HasSubstr("largest force"));
  EXPECT_THAT(beyond_belief({.max_force = NAN}), HasSubstr("largest force"));
  EXPECT_THAT(beyond_belief({.max_torque = -1.0}), HasSubstr("largest torque"));
  EXPECT_THAT(beyond_belief({.workspace = {0.1, INFINITY, 0.1}}), HasSubstr("workspace"));
  EXPECT_THAT(beyond_belief({.rate = 0.01}), HasSubstr("a rate of 0.01 Hz"));
  EXPECT_THAT(beyond_belief({.rate = 1e6}), HasSubstr("rate"));
}

TEST_F(Choose, ADriversFirstDeviceOrTheOneThatIsNamed) {
  EXPECT_EQ(choose_device("strong", there)->id, "strong:7");
  EXPECT_EQ(choose_device(" strong:8 ", there)->id, "strong:8");
  EXPECT_EQ(choose_device("strong:8|delay=5ms", there)->id, "strong:8|delay=5ms");
  EXPECT_EQ(choose_device("knob", there)->id, "knob");
}

TEST_F(Choose, WhatCannotBeOpenedIsPassedOverAndSaid) {
  there[1].missing = "no permission; install the rule";
  EXPECT_EQ(choose_device("strong", there)->id, "strong:8");
  there[2].missing = "no permission; install the rule";
  const auto chosen = choose_device("strong; any-pose; mouse", there);
  ASSERT_TRUE(chosen) << chosen.error().message();
  EXPECT_EQ(chosen->id, "");
  ASSERT_THAT(chosen->notes, SizeIs(2));
  EXPECT_THAT(chosen->notes[0], HasSubstr("install the rule"));
  EXPECT_THAT(chosen->notes[1], HasSubstr("senses position and rotation"));
}

TEST_F(Choose, AnErrorSaysWhyOfEveryAlternative) {
  const auto none = choose_device("falkon; any-pose", there);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message(), HasSubstr("drivers are: knob, strong, weak"));
  EXPECT_THAT(none.error().message(), HasSubstr("no device that senses position and rotation"));
  EXPECT_THAT(none.error().message(), HasSubstr("pliant devices"));
  EXPECT_THAT(choose_device("strong;", {}).value().notes, IsEmpty());
  EXPECT_FALSE(choose_device("", there));
  EXPECT_FALSE(choose_device("any", {}));
}

TEST_F(Choose, NobodyMeansASimulatedDeviceWithoutItsName) {
  for (DeviceInfo& device : there) device.can.simulated = true;
  EXPECT_FALSE(choose_device("any-force", there));
  EXPECT_FALSE(choose_device("any", there));
  EXPECT_EQ(choose_device("strong", there)->id, "strong:7");
}

TEST_F(Choose, ADeviceThatBrakesDoesNotPush) {
  there = {device("weak", "1", 3.0)};
  there[0].can.resists_only = true;
  EXPECT_FALSE(choose_device("any-force", there));
  EXPECT_EQ(choose_device("any", there)->id, "weak:1");
}

}  // namespace
}  // namespace pliant
