#include "devices/drivers/gamepad.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>

#include "devices/drivers/gamepad_evdev.h"
#include "devices/drivers/shaker.h"

namespace pliant {
namespace {

// A device's end of evdev.
struct EmulatedGamepad {
  GamepadTraits traits;
  GamepadState held;  // the kernel's state
  std::vector<GamepadEvent> events;
  std::vector<GamepadOutput> rendered;
  bool unplugged = false;

  explicit EmulatedGamepad(bool rumble, bool constant) {
    traits.name = "emulated";
    for (const int code : {ABS_X, ABS_Y, ABS_RX, ABS_RY}) {
      traits.axes[static_cast<std::size_t>(code)] = {true, -32768, 32767};
      held.axes[static_cast<std::size_t>(code)] = 0;
    }
    traits.axes[ABS_RZ] = {true, 0, 1023};
    for (const int key : {BTN_SOUTH, BTN_EAST, BTN_TL, BTN_TR})
      traits.keys[traits.key_count++] = static_cast<std::uint16_t>(key);
    traits.rumble = rumble;
    traits.constant = constant;
  }
  void say(int type, int code, int value) {
    events.push_back({static_cast<std::uint16_t>(type), static_cast<std::uint16_t>(code), value});
  }
  void report() { say(EV_SYN, SYN_REPORT, 0); }
};

class EmulatedLine final : public GamepadLine {
 public:
  explicit EmulatedLine(EmulatedGamepad& pad) : pad_(pad) {}
  const GamepadTraits& traits() const override { return pad_.traits; }
  Result<std::size_t> read(std::span<GamepadEvent> into) override {
    if (pad_.unplugged) return Error{"emulated", "is gone"};
    const std::size_t count = std::min(into.size(), pad_.events.size());
    std::copy_n(pad_.events.begin(), count, into.begin());
    pad_.events.erase(pad_.events.begin(), pad_.events.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  Status whole_state(GamepadState& state) override {
    if (pad_.unplugged) return Error{"emulated", "is gone"};
    state = pad_.held;
    return Done{};
  }
  Status render(const GamepadOutput& output) override {
    if (pad_.unplugged) return Error{"emulated", "is gone"};
    pad_.rendered.push_back(output);
    return Done{};
  }

 private:
  EmulatedGamepad& pad_;
};

struct PadRig {
  explicit PadRig(bool rumble = true, bool constant = false, const std::string& id = "") : pad(rumble, constant) {
    driver = make_gamepad(
        [this](const std::string&) -> Result<std::unique_ptr<GamepadLine>> {
          return std::unique_ptr<GamepadLine>(std::make_unique<EmulatedLine>(pad));
        },
        [this] { return now; });
    EXPECT_TRUE(driver->open(id).ok());
  }
  DeviceSample run(int milliseconds, const DeviceWrench& wrench = {}) {
    DeviceSample sample;
    for (int i = 0; i < milliseconds; ++i) {
      now += 0.001;
      EXPECT_TRUE(driver->read(sample));
      driver->write(wrench);
    }
    return sample;
  }
  double now = 10.0;  // [s]
  EmulatedGamepad pad;
  std::unique_ptr<Driver> driver;
};

TEST(Gamepad, AStickThatIsHeldGoesOnMovingThoughNothingIsSaid) {
  PadRig rig;
  rig.pad.say(EV_ABS, ABS_X, 32767);
  rig.pad.say(EV_ABS, ABS_RY, -32768);
  rig.pad.report();
  const dvec3 first = rig.run(300).position, second = rig.run(300).position;
  EXPECT_NEAR(second.x - first.x, 0.03, 1e-5);
  EXPECT_NEAR(second.y - first.y, 0.03, 1e-5);
  EXPECT_EQ(second.z, 0.0);
}

TEST(Gamepad, NothingCountsBeforeItsReportIsComplete) {
  PadRig rig;
  rig.pad.say(EV_KEY, BTN_EAST, 1);
  EXPECT_EQ(rig.run(5).buttons, 0u);
  rig.pad.report();
  EXPECT_EQ(rig.run(5).buttons, 2u);
  rig.pad.say(EV_KEY, BTN_EAST, 0);
  rig.pad.say(EV_KEY, KEY_A, 1);
  rig.pad.say(EV_ABS, ABS_RZ, 1023);
  rig.pad.report();
  const DeviceSample sample = rig.run(5);
  EXPECT_EQ(sample.buttons, 0u);
  EXPECT_EQ(sample.grip, 1.0);
}

TEST(Gamepad, AfterLostEventsItAsksForTheWholeState) {
  PadRig rig;
  rig.pad.say(EV_ABS, ABS_X, 32767);
  rig.pad.report();
  rig.run(20);
  rig.pad.say(EV_SYN, SYN_DROPPED, 0);
  rig.pad.say(EV_KEY, BTN_SOUTH, 1);  // of a report whose start is lost
  rig.pad.report();
  rig.pad.held.axes[ABS_X] = 0;
  rig.pad.held.buttons = 8;
  EXPECT_EQ(rig.run(200).buttons, 8u);
  const double x = rig.run(1).position.x;
  EXPECT_NEAR(rig.run(200).position.x, x, 1e-6) << "the stick has been let go meanwhile";
}

TEST(Gamepad, AConstantEffectPointsWhereTheForceDoes) {
  EXPECT_EQ(constant_effect({0, 0, 1}).direction, 0x0000);   // towards the user
  EXPECT_EQ(constant_effect({-1, 0, 0}).direction, 0x4000);  // left
  EXPECT_EQ(constant_effect({0, 0, -1}).direction, 0x8000);  // away
  EXPECT_EQ(constant_effect({1, 0, 0}).direction, 0xc000);   // right
  EXPECT_EQ(constant_effect({0.5, 7, 0}).level, 16384);
  EXPECT_EQ(constant_effect({30, 0, 40}).level, 0x7fff);
  EXPECT_EQ(constant_effect({0, 3, 0}), GamepadOutput{});
  EXPECT_EQ(constant_effect({std::nan(""), 0, 0}), GamepadOutput{});
}

TEST(Gamepad, AForceIsRenewedWhileItLastsAndEndsAtOnce) {
  PadRig rig(false, true);
  EXPECT_TRUE(rig.driver->capabilities().renders_force);
  EXPECT_FALSE(rig.driver->capabilities().resists_only);
  rig.run(1000, {.force = {1.5, 0, 0}});
  EXPECT_GE(rig.pad.rendered.size(), 5u);  // an effect ends by itself after half a second
  EXPECT_LE(rig.pad.rendered.size(), 6u);
  EXPECT_EQ(rig.pad.rendered.back().level, 16384);
  const std::size_t before = rig.pad.rendered.size();
  rig.run(1);
  EXPECT_EQ(rig.pad.rendered.size(), before + 1);
  EXPECT_EQ(rig.pad.rendered.back(), GamepadOutput{});
  rig.run(1000);
  EXPECT_EQ(rig.pad.rendered.size(), before + 1);
}

TEST(Gamepad, ByItselfAStickWithForceIsADisplacement) {
  PadRig rig(false, true);
  rig.pad.say(EV_ABS, ABS_X, 32767);
  rig.pad.report();
  EXPECT_NEAR(rig.run(400).position.x, StickSettings{}.reach, 1e-6);
}

TEST(Gamepad, WithoutForceFeedbackItRendersNothing) {
  PadRig rig(false, false);
  EXPECT_FALSE(rig.driver->capabilities().renders_force);
  rig.run(100, {.force = {1, 1, 1}});
  EXPECT_TRUE(rig.pad.rendered.empty());
}

TEST(Gamepad, ItsRumbleEndsWhenItIsClosed) {
  PadRig rig;
  EXPECT_TRUE(rig.driver->capabilities().resists_only);
  rig.run(100, {.force = {0, Shaker::kFull, 0}});
  EXPECT_GT(rig.pad.rendered.back().strong, 20000);
  rig.driver->close();
  EXPECT_EQ(rig.pad.rendered.back(), GamepadOutput{});
}

TEST(Gamepad, UnpluggedItHasNoSample) {
  PadRig rig;
  rig.run(5);
  rig.pad.unplugged = true;
  DeviceSample sample;
  EXPECT_FALSE(rig.driver->read(sample));
  rig.driver->write({.force = {1, 0, 0}});
  rig.pad.unplugged = false;
  EXPECT_FALSE(rig.driver->read(sample));
  EXPECT_TRUE(rig.driver->open("").ok());
  EXPECT_TRUE(rig.driver->read(sample));
}

// The kernel's own end, where it lets us.
TEST(Gamepad, APseudoDeviceOfTheKernelMovesItAndFeelsItsForce) {
  const int file = ::open("/dev/uinput", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) GTEST_SKIP() << "/dev/uinput: " << std::strerror(errno);
  for (const int type : {EV_KEY, EV_ABS, EV_FF}) ::ioctl(file, UI_SET_EVBIT, type);
  ::ioctl(file, UI_SET_KEYBIT, BTN_SOUTH);
  ::ioctl(file, UI_SET_FFBIT, FF_RUMBLE);
  for (const int code : {ABS_X, ABS_Y}) {
    uinput_abs_setup axis{};
    axis.code = static_cast<std::uint16_t>(code);
    axis.absinfo.minimum = -100;
    axis.absinfo.maximum = 100;
    ::ioctl(file, UI_ABS_SETUP, &axis);
  }
  uinput_setup setup{};
  std::strcpy(setup.name, "pliant test pad");
  setup.ff_effects_max = 4;
  ::ioctl(file, UI_DEV_SETUP, &setup);
  ASSERT_EQ(::ioctl(file, UI_DEV_CREATE), 0);
  std::string id;
  for (int i = 0; i < 100 && id.empty(); ++i) {
    for (const GamepadFound& found : find_gamepads())
      if (found.traits.name == setup.name && found.missing.empty()) id = found.path;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (id.empty()) {
    ::ioctl(file, UI_DEV_DESTROY);
    ::close(file);
    GTEST_SKIP() << "no node under /dev/input came for the pseudo device";
  }
  const std::unique_ptr<Driver> driver = make_gamepad(open_gamepad);
  ASSERT_TRUE(driver->open(id).ok());
  input_event push{}, sync{};
  push.type = EV_ABS, push.code = ABS_X, push.value = 100;
  EXPECT_EQ(::write(file, &push, sizeof push), static_cast<ssize_t>(sizeof push));
  EXPECT_EQ(::write(file, &sync, sizeof sync), static_cast<ssize_t>(sizeof sync));
  DeviceSample sample;
  for (int i = 0; i < 1000 && sample.position.x <= 0.0; ++i) {
    EXPECT_TRUE(driver->read(sample));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GT(sample.position.x, 0.0);
  ::ioctl(file, UI_DEV_DESTROY);
  ::close(file);
  bool lost = false;
  for (int i = 0; i < 1000 && !lost; ++i) {
    lost = !driver->read(sample);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(lost);
}

}  // namespace
}  // namespace pliant
