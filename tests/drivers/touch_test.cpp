#include <dlfcn.h>
#include <gtest/gtest.h>

#include "devices/drivers/touch_x.h"
#include "tests/drivers/fakes/fakes.h"
#include "tests/drivers/until.h"

namespace pliant {
namespace {

// Loads the library once more, so that its state survives while drivers are created and destroyed.
struct TouchLibrary {
  void* library = dlopen(PLIANT_FAKE_HD, RTLD_NOW | RTLD_LOCAL);
  FakeHd& hd = *reinterpret_cast<FakeHd* (*)()>(dlsym(library, "fake_hd"))();
  ~TouchLibrary() { dlclose(library); }
};

TEST(Touch, MillimetresBecomeMetresAndTheLimitsOfTheMakerAreOn) {
  TouchLibrary fake;
  fake.hd.x = 10;
  fake.hd.y = 20;
  fake.hd.z = -30;
  fake.hd.turn = 0.5;
  fake.hd.buttons = 2;
  Touch driver({PLIANT_FAKE_HD});
  const auto opened = driver.open("right hand");
  ASSERT_TRUE(opened) << opened.error().message();
  EXPECT_EQ(driver.capabilities().loop, DeviceLoop::kCallback);
  EXPECT_NEAR(driver.capabilities().max_force, 3.3, 1e-12);
  EXPECT_TRUE(fake.hd.clamp && fake.hd.ramp && fake.hd.limit);
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {.force = {0, 1.5, 0}}, [&](bool came) { return came && fake.hd.fy == 1.5; }));
  EXPECT_NEAR(length(sample.position - dvec3(0.01, 0.02, -0.03)), 0.0, 1e-15);
  EXPECT_NEAR(length(sample.rotation * dvec3(1, 0, 0) - dvec3(std::cos(0.5), std::sin(0.5), 0)), 0.0, 1e-12);
  EXPECT_EQ(sample.buttons, 2u);
  EXPECT_TRUE(soon([&] { return fake.hd.fy == 0.0; })) << "a force that nobody renews is over";
  driver.close();
  EXPECT_FALSE(fake.hd.initialised || fake.hd.running || fake.hd.output);
}

TEST(Touch, ItsLoopCallsTheTickOnTheLibrarysThread) {
  TouchLibrary fake;
  Touch driver({PLIANT_FAKE_HD});
  EXPECT_FALSE(driver.run([] {})) << "before it is opened";
  ASSERT_TRUE(driver.open(""));
  std::atomic<int> ticks{0}, elsewhere{0};
  std::atomic<std::thread::id> caller{};
  ASSERT_TRUE(driver.run([&] {
    if (ticks++ == 0) caller = std::this_thread::get_id();
    if (caller.load() != std::this_thread::get_id()) ++elsewhere;
    DeviceSample sample;
    if (driver.read(sample) && sample.ready) driver.write({.force = {0, 0.25, 0}});
  }));
  EXPECT_FALSE(driver.run([] {})) << "two owners";
  EXPECT_TRUE(soon([&] { return ticks > 50 && fake.hd.fy == 0.25; }));
  EXPECT_NE(caller.load(), std::this_thread::get_id());
  EXPECT_EQ(elsewhere, 0);
  driver.close();
  const int after = ticks;
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(ticks, after);
  EXPECT_EQ(fake.hd.fy, 0.0);
}

TEST(Touch, AfterAFaultOfTheLibraryThePoseIsUnknownForAFrameAndTheForceZero) {
  TouchLibrary fake;
  Touch driver({PLIANT_FAKE_HD});
  ASSERT_TRUE(driver.open("default"));
  std::atomic<int> unknown{0}, forces{0};
  std::atomic<bool> again{false};
  ASSERT_TRUE(driver.run([&] {
    DeviceSample sample;
    driver.read(sample);
    if (!sample.ready) ++unknown;
    if (unknown > 0 && sample.ready) again = true;
    driver.write({.force = {0, 1, 0}});
    ++forces;
  }));
  ASSERT_TRUE(soon([&] { return fake.hd.fy == 1.0; }));
  ASSERT_EQ(unknown, 0);
  fake.hd.next_fault = 0x200;  // warm motors
  EXPECT_TRUE(soon([&] { return again.load(); }));
  EXPECT_GE(unknown, 1);
  fake.hd.calibration = 0x5002;  // its stylus belongs into the inkwell
  EXPECT_TRUE(soon([&] { return fake.hd.fy == 0.0; }));
  fake.hd.calibration = 0x5000;
  EXPECT_TRUE(soon([&] { return fake.hd.fy == 1.0; }));
  fake.hd.x = NAN;
  EXPECT_TRUE(soon([&] { return fake.hd.fy == 0.0; }));
  driver.close();
}

TEST(Touch, SafeMeansThatItsOutputIsOffAndStaysOff) {
  TouchLibrary fake;
  Touch driver({PLIANT_FAKE_HD});
  ASSERT_TRUE(driver.open(""));
  DeviceSample sample;
  ASSERT_TRUE(runs_until(driver, sample, {.force = {0, 1, 0}}, [&](bool) { return fake.hd.fy == 1.0; }));
  driver.make_safe();
  EXPECT_TRUE(runs_until(driver, sample, {.force = {0, 1, 0}}, [&](bool) { return !fake.hd.output; }));
  const int before = fake.hd.frames;
  EXPECT_TRUE(runs_until(driver, sample, {.force = {0, 1, 0}}, [&](bool) { return fake.hd.frames > before + 20; }));
  EXPECT_EQ(fake.hd.fy, 0.0);
  EXPECT_FALSE(fake.hd.output);
}

TEST(Touch, WhatIsMissingIsOneSentence) {
  EXPECT_EQ(
      Touch({"libnothere.so"}).open("").error().message(),
      "libnothere.so: is not installed or cannot be loaded; install 3D Systems' OpenHaptics 3 and the driver of the "
      "device");
  EXPECT_NE(Touch({PLIANT_FAKE_HD_SHORT}).open("").error().message().find("has no function `hdGetError`"),
            std::string::npos);
  TouchLibrary fake;
  Touch driver({PLIANT_FAKE_HD});
  EXPECT_EQ(
      driver.open("left hand").error().message(),
      "touch `left hand`: cannot be opened (error 0x301 of libHD); set it up with the maker's program, and give the "
      "name used there");
  EXPECT_EQ(driver.list()[0].id, "default");
  EXPECT_FALSE(Touch({"libnothere.so"}).list()[0].missing.empty());
}

}  // namespace
}  // namespace pliant
