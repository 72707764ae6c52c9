// Driver `gamepad`: gamepads, joysticks and wheels through Linux's evdev, with force feedback if supported.
//
// Pose: the first stick moves right and towards the user, the second stick up and down and about the vertical
// (stick_control.h). A device with FF_CONSTANT pushes its stick: control=position is then the default, and the force
// along x and z is rendered as a share of the device's maximum. With only FF_RUMBLE, force is rendered as vibration.
// Buttons: in the order of their codes; the clutch is BTN_TL (joystick: BTN_THUMB). Grip: the right trigger.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "devices/drivers/stick_control.h"
#include "pliant/driver.h"

namespace pliant {

// linux/input.h's event, without its time.
struct GamepadEvent {
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;
};

// Axes, buttons and effects of the device.
struct GamepadTraits {
  std::string name;
  struct Axis {
    bool there = false;
    std::int32_t min = 0, max = 0;
  };
  std::array<Axis, 64> axes{};           // by ABS_ code
  std::array<std::uint16_t, 32> keys{};  // codes of buttons, in their order
  std::size_t key_count = 0;
  bool rumble = false, constant = false;
};

struct GamepadState {
  std::array<std::int32_t, 64> axes{};  // raw, by ABS_ code
  std::uint32_t buttons = 0;            // bit i: GamepadTraits::keys[i]
};

// Applies events to `pending`; at SYN_REPORT `state` becomes `pending`. False: events were lost (SYN_DROPPED). Then all
// events up to the next SYN_REPORT are ignored, and the device's whole state is read.
class GamepadParser {
 public:
  explicit GamepadParser(const GamepadTraits& traits = {}) : traits_(traits) {}
  void begin(const GamepadState& state) { state_ = pending_ = state; }
  // True: the caller must read the whole state and pass it to begin().
  bool take(const GamepadEvent& event);
  const GamepadState& state() const { return state_; }
  // Value of an ABS_ code, in [-1, 1]; 0 if there is no such axis.
  double axis(std::uint16_t code) const;
  bool button(std::uint16_t key) const;
  // A trigger, 0 to 1: an axis whose rest position is its minimum.
  double trigger(std::uint16_t code) const;

 private:
  GamepadTraits traits_;
  GamepadState state_, pending_;
  bool dropping_ = false;
};

// The effects to render.
struct GamepadOutput {
  std::uint16_t strong = 0, weak = 0;  // FF_RUMBLE
  std::int16_t level = 0;              // FF_CONSTANT, 0 to 0x7fff
  std::uint16_t direction = 0;         // FF_CONSTANT: 0 towards the user, 0x4000 left, 0x8000 away, 0xc000 right
  bool operator==(const GamepadOutput&) const = default;
};
// The share [1] of its maximum force, in world axes, as level and direction.
GamepadOutput constant_effect(const dvec3& share);

// The connection to one gamepad: evdev's, or a test's.
class GamepadLine {
 public:
  virtual ~GamepadLine() = default;
  virtual const GamepadTraits& traits() const = 0;
  // Returns at once; 0: no events. Error: the device is gone.
  virtual Result<std::size_t> read(std::span<GamepadEvent> into) = 0;
  virtual Status whole_state(GamepadState& state) = 0;
  // Returns at once; the newest output replaces older ones.
  virtual Status render(const GamepadOutput& output) = 0;
  virtual bool safe_line(SafeLine&) const { return false; }  // Driver::safe_line, Driver::node
  virtual std::string node() const { return {}; }
};
using GamepadOpener = std::function<Result<std::unique_ptr<GamepadLine>>(const std::string& id)>;

// `id`: as printed by `pliant devices` (its unique id, or /dev/input/eventN), followed by stick_control.h's options.
std::unique_ptr<Driver> make_gamepad(GamepadOpener opener, SecondsClock clock = monotonic_seconds);
Status register_gamepad();

}  // namespace pliant
