#include "devices/drivers/gamepad.h"

#include <linux/input.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "devices/drivers/gamepad_evdev.h"
#include "devices/drivers/shaker.h"

namespace pliant {
namespace {

constexpr double kFullForce = 3.0;      // [N] rendered at full strength; the device's actual force is unknown
constexpr double kRumbleEvery = 0.005;  // [s]
constexpr double kRenewAfter = 0.2;     // [s] an effect ends by itself, so that a crashed program does not keep pushing
constexpr int kMostEvents = 256;        // per tick
constexpr const char* kName = "gamepad";

DeviceCapabilities what_it_can(const GamepadTraits& traits) {
  DeviceCapabilities can{.renders_force = traits.constant || traits.rumble, .workspace = StickSettings{}.extent};
  can.senses_rotation = traits.axes[ABS_RX].there || traits.axes[ABS_RZ].there;
  can.senses_grip = traits.axes[ABS_RZ].there || traits.axes[ABS_GAS].there;
  if (can.renders_force) can.max_force = traits.constant ? kFullForce : Shaker::kFull;
  can.renders_vibration = traits.rumble;
  can.resists_only = can.renders_force && !traits.constant;
  return can;
}

class Gamepad final : public Driver {
 public:
  Gamepad(GamepadOpener opener, SecondsClock clock) : opener_(std::move(opener)), clock_(std::move(clock)) {}
  ~Gamepad() override { Gamepad::close(); }

  Status open(const std::string& id) override {
    close();
    const Result<DeviceWords> words = parse_device_words(kName, id, kStickKeys);
    if (!words) return words.error();
    Result<std::unique_ptr<GamepadLine>> line = opener_(words->id);
    if (!line) return line.error();
    StickSettings usual;
    usual.rate = !(*line)->traits().constant;
    const Result<StickSettings> settings = stick_settings(kName, *words, usual);
    if (!settings) return settings.error();
    line_ = std::move(*line);
    parser_ = GamepadParser(line_->traits());
    GamepadState state;
    if (const Status asked = line_->whole_state(state); !asked) {
      line_.reset();
      return asked.error();
    }
    parser_.begin(state);
    control_ = StickControl(*settings);
    extent_ = settings->extent;
    can_ = what_it_can(line_->traits());
    shaker_ = {};
    sent_ = {};
    gone_ = false;
    stepped_at_ = written_at_ = sent_at_ = clock_();
    return Done{};
  }
  DeviceCapabilities capabilities() const override {
    DeviceCapabilities can = can_;
    can.workspace = extent_;
    return can;
  }

  // evdev reports only changes: the pose is known as long as the connection exists.
  bool read(DeviceSample& sample) override {
    if (!line_ || gone_) return false;
    std::array<GamepadEvent, 64> events;
    for (int taken = 0; taken < kMostEvents;) {
      const Result<std::size_t> count = line_->read(events);
      gone_ = !count;
      if (gone_) return false;
      if (*count == 0) break;
      for (std::size_t i = 0; i < *count && i < events.size(); ++i) {
        if (!parser_.take(events[i])) continue;
        GamepadState state;
        gone_ = !line_->whole_state(state);
        if (gone_) return false;
        parser_.begin(state);
      }
      taken += static_cast<int>(*count);
    }
    const double now = clock_();
    const bool pad =
        line_->traits().axes[ABS_RX].there;  // otherwise a joystick: ABS_RZ is its twist, ABS_THROTTLE its height
    const dvec3 move(parser_.axis(ABS_X), pad ? -parser_.axis(ABS_RY) : 0.0, parser_.axis(ABS_Y));
    const dvec3 turn(0.0, pad ? -parser_.axis(ABS_RX) : -parser_.axis(ABS_RZ), 0.0);
    control_.step(move, turn, parser_.button(pad ? BTN_TL : BTN_THUMB), now - stepped_at_);
    stepped_at_ = now;
    sample = {};
    sample.position = control_.position();
    sample.rotation = control_.rotation();
    sample.grip = line_->traits().axes[ABS_GAS].there ? parser_.trigger(ABS_GAS) : pad ? parser_.trigger(ABS_RZ) : 0.0;
    sample.buttons = parser_.state().buttons;
    sample.time = now;
    return true;
  }

  void write(const DeviceWrench& wrench) override {
    if (!line_ || gone_ || !can_.renders_force) return;
    const double now = clock_();
    GamepadOutput output;
    if (line_->traits().constant) output = constant_effect(wrench.force / kFullForce);
    const Shaking shaking = shaker_.step(wrench.force, now - written_at_);
    written_at_ = now;
    if (line_->traits().rumble) {
      output.strong =
          line_->traits().constant ? std::uint16_t(0) : static_cast<std::uint16_t>(65535.0 * shaking.strong);
      output.weak = static_cast<std::uint16_t>(65535.0 * shaking.weak);
    }
    const bool nothing = output == GamepadOutput{};
    if (output == sent_ && (nothing || now - sent_at_ < kRenewAfter)) return;
    if (!nothing && now - sent_at_ < kRumbleEvery) return;
    gone_ = !line_->render(output);
    sent_ = output;
    sent_at_ = now;
  }
  bool safe_line(SafeLine& line) const override {
    return line_ && !gone_ && can_.renders_force && line_->safe_line(line);
  }
  std::string node() const override { return line_ ? line_->node() : std::string(); }
  bool gone() const override { return gone_; }
  void close() override {
    if (line_) write({});
    line_.reset();
  }

 private:
  GamepadOpener opener_;
  SecondsClock clock_;
  std::unique_ptr<GamepadLine> line_;
  GamepadParser parser_;
  StickControl control_;
  Shaker shaker_;
  GamepadOutput sent_;
  DeviceCapabilities can_{.renders_force = false};
  dvec3 extent_ = StickSettings{}.extent;
  double stepped_at_ = 0.0, written_at_ = 0.0, sent_at_ = 0.0;
  bool gone_ = false;
};

}  // namespace

bool GamepadParser::take(const GamepadEvent& event) {
  if (event.type == EV_SYN && event.code == SYN_DROPPED) dropping_ = true;
  if (event.type == EV_SYN && event.code == SYN_REPORT) {
    const bool lost = dropping_;
    dropping_ = false;
    if (!lost) state_ = pending_;
    return lost;
  }
  if (dropping_) return false;
  if (event.type == EV_ABS && event.code < pending_.axes.size()) pending_.axes[event.code] = event.value;
  if (event.type == EV_KEY)
    for (std::size_t i = 0; i < traits_.key_count && i < traits_.keys.size(); ++i)
      if (traits_.keys[i] == event.code)
        pending_.buttons = event.value ? pending_.buttons | 1u << i : pending_.buttons & ~(1u << i);
  return false;
}

double GamepadParser::trigger(std::uint16_t code) const {
  const GamepadTraits::Axis axis = code < traits_.axes.size() ? traits_.axes[code] : GamepadTraits::Axis{};
  if (!axis.there || axis.max <= axis.min) return 0.0;
  return std::clamp((double(state_.axes[code]) - axis.min) / (double(axis.max) - axis.min), 0.0, 1.0);
}

double GamepadParser::axis(std::uint16_t code) const {
  const GamepadTraits::Axis axis = code < traits_.axes.size() ? traits_.axes[code] : GamepadTraits::Axis{};
  return axis.there && axis.max > axis.min ? 2.0 * trigger(code) - 1.0 : 0.0;
}

bool GamepadParser::button(std::uint16_t key) const {
  for (std::size_t i = 0; i < traits_.key_count && i < traits_.keys.size(); ++i)
    if (traits_.keys[i] == key) return state_.buttons & 1u << i;
  return false;
}

GamepadOutput constant_effect(const dvec3& share) {
  GamepadOutput output;
  const double size = std::hypot(share.x, share.z);
  if (!(size > 0.0) || !std::isfinite(size)) return output;
  output.level = static_cast<std::int16_t>(std::lround(0x7fff * std::min(size, 1.0)));
  // From towards the user (+z) over left (-x): clockwise seen from above.
  const double angle = std::atan2(-share.x, share.z);
  output.direction = static_cast<std::uint16_t>(std::lround(angle / (2.0 * std::numbers::pi) * 65536.0) & 0xffff);
  return output;
}

std::unique_ptr<Driver> make_gamepad(GamepadOpener opener, SecondsClock clock) {
  return std::make_unique<Gamepad>(std::move(opener), std::move(clock));
}

Status register_gamepad() {
  return register_driver(
      kName, [] { return make_gamepad(open_gamepad); },
      [] {
        std::vector<DeviceInfo> infos;
        for (const GamepadFound& found : find_gamepads())
          infos.push_back(
              {kName, found.id, found.traits.name, found.missing, what_it_can(found.traits), found.hardware, true});
        return infos;
      });
}

}  // namespace pliant
