#include "devices/drivers/sony_pad.h"

#include <algorithm>
#include <cmath>

#include "devices/drivers/motion_filter.h"
#include "devices/drivers/shaker.h"
#include "devices/ports/hid_descriptor.h"
#include "devices/ports/hid_port.h"
#include "devices/ports/newest_port.h"

namespace pliant {
namespace {

constexpr double kFullGrip = 4.0;    // [N] that makes the trigger resist fully; what it then renders is not published
constexpr double kLostAfter = 0.05;  // [s] a controller reports every 1 to 15 ms, moved or not
constexpr double kSendEvery = 0.01;  // [s] motors are slower
constexpr double kSendAgain = 0.2;   // [s] what a guard process has ended shakes again
constexpr int kMostReports = 64;     // in one tick
constexpr std::uint16_t kNewRumble = 0x0215;  // firmware from which the motors have another flag

const HidMatch kDualSense[] = {{0x054c, {0x0ce6, 0x0df2}, 1, 5}};
const HidMatch kDualShock[] = {{0x054c, {0x05c4, 0x09cc, 0x0ba0}, 1, 5}};

DeviceCapabilities what_it_can(SonyModel model) {
  const bool sense = model == SonyModel::kDualSense;
  return {.senses_rotation = true,
          .max_force = Shaker::kFull,
          .senses_grip = true,
          .renders_grip = sense,
          .renders_vibration = true,
          .resists_only = true,
          .workspace = StickSettings{}.extent};
}

// Which line a controller is on, how its sensors are calibrated, and how old its firmware is.
struct SonyLine {
  bool bluetooth = false, new_rumble = false;
  SonyCalibration calibration = nominal_calibration();
};

// By Bluetooth the first of these feature reports makes the controller send its whole input.
SonyLine learn_line(SonyModel model, PacketPort& port) {
  SonyLine line;
  const bool sense = model == SonyModel::kDualSense;
  const Result<HidLayout> layout = parse_hid_descriptor(port.descriptor());
  line.bluetooth = layout && layout->bytes(HidKind::kInput, sense ? 0x31 : 0x11) > 0;
  std::array<std::uint8_t, 64> report{};
  const std::uint8_t number = !sense && !line.bluetooth ? 0x02 : 0x05;
  const std::size_t size = !sense && !line.bluetooth ? 37 : 41;
  for (int attempt = 0; attempt < 3; ++attempt) {
    const Result<std::size_t> length = port.feature(number, std::span(report).first(size));
    if (!length) continue;
    const auto found = parse_sony_calibration(model, line.bluetooth, std::span(report).first(std::min(*length, size)));
    if (!found) continue;
    line.calibration = *found;
    break;
  }
  if (!sense) return line;
  const Result<std::size_t> length = port.feature(0x20, report);
  line.new_rumble = length && *length >= 46 && report[0] == 0x20 && (report[44] | report[45] << 8) >= kNewRumble;
  return line;
}

class SonyPad final : public Driver {
 public:
  SonyPad(SonyModel model, PortOpener opener, SecondsClock clock)
      : model_(model), opener_(std::move(opener)), clock_(std::move(clock)) {}
  ~SonyPad() override { SonyPad::close(); }

  Status open(const std::string& id) override {
    close();
    const Result<DeviceWords> words = parse_device_words(name(), id, kStickKeys);
    if (!words) return words.error();
    const Result<StickSettings> settings = stick_settings(name(), *words, {});
    if (!settings) return settings.error();
    Result<std::unique_ptr<PacketPort>> port = opener_(words->id);
    if (!port) return port.error();
    port_ = std::move(*port);
    line_ = learn_line(model_, *port_);
    control_ = StickControl(*settings);
    extent_ = settings->extent;
    motion_ = {};
    input_ = {};
    sent_ = {};
    shaker_ = {};
    sequence_ = 0;
    heard_ = gone_ = false;
    stepped_at_ = written_at_ = sent_at_ = clock_();
    return Done{};
  }
  DeviceCapabilities capabilities() const override {
    DeviceCapabilities can = what_it_can(model_);
    can.workspace = extent_;
    return can;
  }

  bool read(DeviceSample& sample) override {
    if (!port_ || gone_) return false;
    const double now = clock_();
    std::array<std::uint8_t, 128> packet;
    for (int i = 0; i < kMostReports; ++i) {
      const Result<std::size_t> length = port_->receive(packet, 0.0);
      gone_ = !length;
      if (gone_) return false;
      if (*length == 0) break;
      SonyInput input;
      if (parse_sony(model_, line_.bluetooth, {packet.data(), *length}, input) == SonyParse::kSample) take(input, now);
    }
    const dvec3 move(input_.sticks[0], -input_.sticks[3], input_.sticks[1]);
    const bool known = heard_ && now - heard_at_ < kLostAfter;
    control_.step(known ? move : dvec3(0), dvec3(0), input_.buttons & kLeftShoulder, now - stepped_at_);
    stepped_at_ = now;
    if (!known) return false;
    sample = {};
    sample.position = control_.position();
    sample.rotation = motion_.rotation();
    sample.grip = input_.right;
    sample.buttons = input_.buttons;
    sample.time = now;
    sample.battery = input_.battery;
    sample.charging = input_.charging;
    return true;
  }
  bool gone() const override { return gone_; }

  void write(const DeviceWrench& wrench) override {
    if (!port_ || gone_) return;
    const double now = clock_();
    const Shaking shaking = shaker_.step(wrench.force, now - written_at_);
    written_at_ = now;
    const auto byte = [](double share) { return static_cast<std::uint8_t>(std::lround(255.0 * share)); };
    SonyOutput output{byte(shaking.strong), byte(shaking.weak), 0};
    if (model_ == SonyModel::kDualSense && wrench.grip > 0.0)
      output.resistance =
          static_cast<std::uint8_t>(std::ceil(kMostResistance * std::min(wrench.grip / kFullGrip, 1.0)));
    // Nothing leaves at once, everything else when its time has come.
    const bool nothing = output == SonyOutput{};
    if (output == sent_ && (nothing || now - sent_at_ < kSendAgain)) return;
    if (!nothing && now - sent_at_ < kSendEvery) return;
    std::array<std::uint8_t, kLongestSonyOutput> report;
    const std::size_t length = write_report(output, report);
    if (!port_->send({report.data(), length})) {
      gone_ = true;
      return;
    }
    sequence_ = (sequence_ + 1) & 0xf;
    sent_ = output;
    sent_at_ = now;
  }

  // The report that lets both motors and the trigger rest.
  bool safe_line(SafeLine& line) const override {
    if (!port_ || gone_ || port_->file() < 0) return false;
    std::array<std::uint8_t, kLongestSonyOutput> report;
    line.size = write_report({}, report);
    std::copy_n(report.begin(), line.size, line.bytes.begin());
    line.descriptor = port_->file();
    return true;
  }
  std::string node() const override { return port_ ? port_->node() : std::string(); }

  void close() override {
    if (port_) write({});
    port_.reset();
  }

 private:
  const char* name() const { return model_ == SonyModel::kDualSense ? "dualsense" : "dualshock4"; }

  std::size_t write_report(const SonyOutput& output, std::span<std::uint8_t, kLongestSonyOutput> report) const {
    return model_ == SonyModel::kDualSense
               ? dualsense_output(output, line_.bluetooth, line_.new_rumble, sequence_, report)
               : dualshock_output(output, line_.bluetooth, report);
  }

  void take(const SonyInput& input, double now) {
    const bool sense = model_ == SonyModel::kDualSense;
    if (heard_ && input.sequence == input_.sequence && input.time == input_.time) return;  // a repeated report
    const std::uint32_t ticks = sense ? input.time - input_.time : (input.time - input_.time) & 0xffff;
    const double dt = heard_ ? ticks * (sense ? 1e-6 / 3.0 : 16e-6 / 3.0) : 0.0;
    dvec3 turning, felt;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      turning[axis] = (input.gyro[i] - line_.calibration.gyro_bias[axis]) * line_.calibration.gyro_scale[axis];
      felt[axis] = (input.acceleration[i] - line_.calibration.acceleration_bias[axis]) *
                   line_.calibration.acceleration_scale[axis];
    }
    motion_.step(turning, felt, dt);
    input_ = input;
    heard_ = true;
    heard_at_ = now;
  }

  SonyModel model_;
  PortOpener opener_;
  SecondsClock clock_;
  std::unique_ptr<PacketPort> port_;
  SonyLine line_;
  MotionFilter motion_;
  StickControl control_;
  Shaker shaker_;
  SonyInput input_;
  SonyOutput sent_;
  dvec3 extent_ = StickSettings{}.extent;
  double heard_at_ = 0.0, stepped_at_ = 0.0, written_at_ = 0.0, sent_at_ = 0.0;
  std::uint8_t sequence_ = 0;
  bool heard_ = false, gone_ = false;
};

Status register_pad(const char* name, SonyModel model, std::span<const HidMatch> matches) {
  return register_driver(
      name,
      [=] {
        return make_sony_pad(model, [=](const std::string& id) -> Result<std::unique_ptr<PacketPort>> {
          Result<std::unique_ptr<PacketPort>> line = open_hid(matches, id);
          if (!line) return line.error();
          return newest_port(std::move(*line));
        });
      },
      [=] {
        std::vector<DeviceInfo> infos;
        for (const HidFound& found : find_hid(matches))
          infos.push_back({name, found.id, found.name + (found.bluetooth ? " (Bluetooth)" : ""), found.missing,
                           what_it_can(model), found.hardware});
        return infos;
      });
}

}  // namespace

std::unique_ptr<Driver> make_sony_pad(SonyModel model, PortOpener opener, SecondsClock clock) {
  return std::make_unique<SonyPad>(model, std::move(opener), std::move(clock));
}

Status register_dualsense() {
  return register_pad("dualsense", SonyModel::kDualSense, kDualSense);
}
Status register_dualshock4() {
  return register_pad("dualshock4", SonyModel::kDualShock, kDualShock);
}

}  // namespace pliant
