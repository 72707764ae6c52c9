#include "devices/drivers/force_dimension.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include "tests/drivers/fakes/fakes.h"
#include "tests/drivers/until.h"

namespace pliant {
namespace {

// Loads the library once more, so that its state survives while drivers are created and destroyed.
struct Fake {
  void* library = dlopen(PLIANT_FAKE_DHD, RTLD_NOW | RTLD_LOCAL);
  FakeDhd& dhd = *reinterpret_cast<FakeDhd* (*)()>(dlsym(library, "fake_dhd"))();
  ~Fake() { dlclose(library); }
};

TEST(ForceDimension, PosesAndForcesAreTurnedIntoWorldAxesAndBack) {
  Fake fake;
  fake.dhd.x = 0.01;  // towards the operator
  fake.dhd.y = 0.02;  // right
  fake.dhd.z = 0.03;  // up
  ForceDimension driver({PLIANT_FAKE_DHD});
  const auto opened = driver.open("");
  ASSERT_TRUE(opened) << opened.error().message();
  EXPECT_EQ(driver.capabilities().max_force, 12.0);
  EXPECT_TRUE(driver.capabilities().senses_rotation);
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {.force = {1, 2, 3}}, [&](bool came) { return came && fake.dhd.fz == 2.0; }));
  EXPECT_EQ(dvec3(fake.dhd.fx.load(), fake.dhd.fy.load(), fake.dhd.fz.load()), dvec3(3, 1, 2));
  EXPECT_EQ(sample.position, dvec3(0.02, 0.03, 0.01));
  EXPECT_TRUE(sample.ready);
  EXPECT_EQ(sample.buttons, 1u);
  // About the vendor's vertical, from the user to the right: a vector towards the user becomes one to the right.
  EXPECT_NEAR(length(sample.rotation * dvec3(0, 0, 1) - dvec3(1, 0, 0)), 0.0, 1e-12);
  EXPECT_NEAR(length(sample.rotation * dvec3(0, 1, 0) - dvec3(0, 1, 0)), 0.0, 1e-12);
  driver.close();
  EXPECT_FALSE(fake.dhd.open);
  EXPECT_EQ(fake.dhd.stops, 1) << "its brakes";
  EXPECT_EQ(fake.dhd.fz, 0.0);
}

TEST(ForceDimension, AForceThatNobodyRenewsIsOver) {
  Fake fake;
  ForceDimension driver({PLIANT_FAKE_DHD});
  ASSERT_TRUE(driver.open("0"));
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {.force = {0, 5, 0}}, [&](bool) { return fake.dhd.fz == 5.0; }));
  EXPECT_TRUE(soon([&] { return fake.dhd.fz == 0.0; }));
}

TEST(ForceDimension, SafeMeansBrakesAndNoForceUntilItIsOpenedAgain) {
  Fake fake;
  ForceDimension driver({PLIANT_FAKE_DHD});
  ASSERT_TRUE(driver.open("0"));
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {.force = {0, 5, 0}}, [&](bool) { return fake.dhd.fz == 5.0; }));
  driver.make_safe();
  ASSERT_TRUE(runs_until(driver, sample, {.force = {0, 5, 0}}, [&](bool) { return fake.dhd.stops > 0; }));
  ASSERT_TRUE(runs_until(driver, sample, {.force = {0, 5, 0}}, [&](bool) { return !sample.ready; }));
  const int before = fake.dhd.exchanges;
  ASSERT_TRUE(
      runs_until(driver, sample, {.force = {0, 5, 0}}, [&](bool) { return fake.dhd.exchanges > before + 100; }));
  EXPECT_EQ(fake.dhd.fz, 0.0);
  EXPECT_EQ(fake.dhd.stops, 1);
  ASSERT_TRUE(driver.open("0"));
  EXPECT_TRUE(runs_until(driver, sample, {.force = {0, 5, 0}}, [&](bool) { return fake.dhd.fz == 5.0; }));
}

TEST(ForceDimension, AForceThatTheDeviceHasSwitchedOffIsAPoseThatIsNotReady) {
  Fake fake;
  ForceDimension driver({PLIANT_FAKE_DHD});
  ASSERT_TRUE(driver.open("0"));
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return came && sample.ready; }));
  fake.dhd.force_button = false;
  EXPECT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return came && !sample.ready; }));
  fake.dhd.force_button = true;
  EXPECT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return came && sample.ready; }));
}

TEST(ForceDimension, AnUnpluggedDeviceIsFoundAgainAndNaNIsNoPose) {
  Fake fake;
  ForceDimension driver({PLIANT_FAKE_DHD});
  ASSERT_TRUE(driver.open("0"));
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return came && sample.ready; }));
  fake.dhd.x = NAN;
  ASSERT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return came && !sample.ready; }));
  EXPECT_TRUE(std::isfinite(sample.position.z));
  fake.dhd.x = 0;
  fake.dhd.unplugged = true;
  ASSERT_TRUE(soon([&] { return !fake.dhd.open; }));
  driver.read(sample);
  EXPECT_FALSE(driver.read(sample));
  fake.dhd.unplugged = false;
  EXPECT_TRUE(runs_until(driver, sample, {}, [&](bool came) { return came && sample.ready; }));
  driver.close();
  EXPECT_EQ(fake.dhd.opens, fake.dhd.closes);
}

TEST(ForceDimension, WhatIsMissingIsOneSentence) {
  EXPECT_EQ(
      ForceDimension({"libnothere.so.1", "libnorthere.so"}).open("").error().message(),
      "libnothere.so.1, libnorthere.so: is not installed or cannot be loaded; install Force Dimension's SDK 3 with "
      "its shared libraries");
  EXPECT_NE(ForceDimension({PLIANT_FAKE_DHD_SHORT})
                .open("")
                .error()
                .message()
                .find("has no function `dhdGetOrientationFrame`; install a newer version of it"),
            std::string::npos);
  Fake fake;
  ForceDimension driver({PLIANT_FAKE_DHD});
  EXPECT_EQ(
      driver.open("7").error().message(),
      "forcedimension `7`: is not there, the library finds 1; plug it in, switch it on, and see that its udev rule "
      "is installed");
  EXPECT_FALSE(driver.open("left"));
  EXPECT_FALSE(driver.open("-1"));
  fake.dhd.calibrated = false;
  EXPECT_EQ(driver.open("0").error().message(),
            "forcedimension `0`: is not calibrated; run Force Dimension's HapticInit once after each power-up");
  EXPECT_FALSE(fake.dhd.open);
  const auto listed = driver.list();
  ASSERT_EQ(listed.size(), 1u);
  EXPECT_EQ(listed[0].id, "0");
  fake.dhd.devices = 0;
  EXPECT_FALSE(driver.list()[0].missing.empty());
  EXPECT_NE(ForceDimension({"libnothere.so.1"}).list()[0].missing.find("libnothere.so.1"), std::string::npos);
}

}  // namespace
}  // namespace pliant
