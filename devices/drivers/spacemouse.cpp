#include "devices/drivers/spacemouse.h"

#include <algorithm>
#include <cstdlib>

#include "devices/ports/hid_port.h"

namespace pliant {
namespace {

constexpr double kUsualScale = 350.0;  // counts at full deflection, where the descriptor does not say
constexpr double kQuiet = 0.25;        // [s] watchdog: a deflected cap reports every 8 to 16 ms; without reports for
                                       // this time it counts as released
constexpr std::uint32_t kClutch = 2;   // the second button
constexpr int kMostSpacemouseReports = 64;  // per tick

const HidMatch kSpacemouseMatches[] = {
    {0x046d, {0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625, 0xc626, 0xc627, 0xc628, 0xc629, 0xc62b}, 1, 8},
    {0x256f, {0xc62e, 0xc62f, 0xc631, 0xc632, 0xc633, 0xc635, 0xc636, 0xc638, 0xc63a}, 1, 8},
};

SpaceMouseLayout usual_layout() {
  SpaceMouseLayout layout;
  layout.hid.numbered = true;
  for (std::uint32_t i = 0; i < 6; ++i)
    layout.axes[i] = {HidKind::kInput,
                      static_cast<std::uint8_t>(1 + i / 3),
                      16 * (i % 3),
                      16,
                      1,
                      static_cast<std::uint16_t>(0x30 + i),
                      -350,
                      350};
  for (std::uint16_t i = 0; i < 16; ++i)
    layout.buttons.push_back({HidKind::kInput, 3, i, 1, 9, static_cast<std::uint16_t>(i + 1), 0, 1});
  return layout;
}

// Counts to [-1, 1]. Some descriptors declare the whole int16 range, which no cap reaches.
double scaled(const HidField& field, std::int32_t value) {
  const double most = std::max(std::abs(double(field.min)), std::abs(double(field.max)));
  return std::clamp(value / (most >= 64.0 && most <= 4096.0 ? most : kUsualScale), -1.0, 1.0);
}

dvec3 world_of(const std::array<double, 6>& axes, std::size_t first) {
  return {axes[first], -axes[first + 2], axes[first + 1]};
}

DeviceCapabilities what_it_can() {
  return {.senses_rotation = true, .renders_force = false, .workspace = StickSettings{}.extent};
}

class SpaceMouse final : public Driver {
 public:
  SpaceMouse(PortOpener opener, SecondsClock clock) : opener_(std::move(opener)), clock_(std::move(clock)) {}

  Status open(const std::string& id) override {
    close();
    const Result<DeviceWords> words = parse_device_words("spacemouse", id, kStickKeys);
    if (!words) return words.error();
    const Result<StickSettings> settings = stick_settings("spacemouse", *words, {});
    if (!settings) return settings.error();
    Result<std::unique_ptr<PacketPort>> port = opener_(words->id);
    if (!port) return port.error();
    Result<SpaceMouseLayout> layout = spacemouse_layout((*port)->descriptor());
    if (!layout) return layout.error();
    layout_ = std::move(*layout);
    state_ = {};
    control_ = StickControl(*settings);
    extent_ = settings->extent;
    heard_at_ = stepped_at_ = clock_();
    port_ = std::move(*port);
    return Done{};
  }
  DeviceCapabilities capabilities() const override {
    DeviceCapabilities can = what_it_can();
    can.workspace = extent_;
    return can;
  }

  // A cap at rest sends nothing: the pose is known as long as the connection exists.
  bool read(DeviceSample& sample) override {
    if (!port_ || gone_) return false;
    const double now = clock_();
    std::array<std::uint8_t, 64> packet;
    for (int i = 0; i < kMostSpacemouseReports; ++i) {
      const Result<std::size_t> length = port_->receive(packet, 0.0);
      gone_ = !length;
      if (gone_) return false;
      if (*length == 0) break;
      if (parse_spacemouse(layout_, {packet.data(), *length}, state_) == SpaceMousePart::kAxes) heard_at_ = now;
    }
    if (now - heard_at_ > kQuiet) state_.axes = {};
    control_.step(world_of(state_.axes, 0), world_of(state_.axes, 3), state_.buttons & kClutch, now - stepped_at_);
    stepped_at_ = now;
    sample = {};
    sample.position = control_.position();
    sample.rotation = control_.rotation();
    sample.buttons = state_.buttons;
    sample.time = now;
    return true;
  }
  void write(const DeviceWrench&) override {}
  bool gone() const override { return gone_; }
  void close() override {
    port_.reset();
    gone_ = false;
  }

 private:
  PortOpener opener_;
  SecondsClock clock_;
  std::unique_ptr<PacketPort> port_;
  SpaceMouseLayout layout_;
  SpaceMouseState state_;
  StickControl control_;
  dvec3 extent_ = StickSettings{}.extent;
  double heard_at_ = 0.0, stepped_at_ = 0.0;
  bool gone_ = false;
};

std::vector<DeviceInfo> list_spacemice() {
  std::vector<DeviceInfo> infos;
  for (const HidFound& found : find_hid(kSpacemouseMatches))
    infos.push_back({"spacemouse", found.id, found.name, found.missing, what_it_can(), found.hardware});
  return infos;
}

}  // namespace

Result<SpaceMouseLayout> spacemouse_layout(std::span<const std::uint8_t> descriptor) {
  if (descriptor.empty()) return usual_layout();
  Result<HidLayout> hid = parse_hid_descriptor(descriptor);
  if (!hid) return hid.error();
  SpaceMouseLayout layout;
  layout.hid = std::move(*hid);
  std::array<bool, 6> seen{};
  for (const HidField& field : layout.hid.fields) {
    if (field.kind != HidKind::kInput) continue;
    if (field.page == 1 && field.usage >= 0x30 && field.usage <= 0x35 && !seen[field.usage - 0x30]) {
      layout.axes[field.usage - 0x30] = field;
      seen[field.usage - 0x30] = true;
    }
    if (field.page == 9 && field.bits == 1 && layout.buttons.size() < 32) layout.buttons.push_back(field);
  }
  if (std::find(seen.begin(), seen.end(), false) != seen.end())
    return Error{"spacemouse", "its report descriptor does not hold six axes", "it cannot be used as one"};
  return layout;
}

SpaceMousePart parse_spacemouse(const SpaceMouseLayout& layout, std::span<const std::uint8_t> report,
                                SpaceMouseState& state) {
  SpaceMousePart part = SpaceMousePart::kNothing;
  std::int32_t value = 0;
  const bool described = !layout.hid.fields.empty();
  if (report.empty() ||
      (described && layout.hid.numbered && report.size() < layout.hid.bytes(HidKind::kInput, report[0])))
    return part;
  if (!described && report[0] <= 2 && report.size() < 7) return part;
  // Without a descriptor, six axes in one report are recognised by its length.
  const bool six = !described && report.size() >= 13 && report[0] == 1;
  for (std::size_t i = 0; i < layout.axes.size(); ++i) {
    HidField field = layout.axes[i];
    if (six) field.report = 1, field.bit = static_cast<std::uint32_t>(16 * i);
    if (!hid_value(layout.hid, field, report, value)) continue;
    state.axes[i] = scaled(field, value);
    part = SpaceMousePart::kAxes;
  }
  std::uint32_t mask = 0;
  bool has_buttons = false;
  for (std::size_t i = 0; i < layout.buttons.size() && i < 32; ++i) {
    if (!hid_value(layout.hid, layout.buttons[i], report, value)) continue;
    has_buttons = true;
    if (value) mask |= 1u << i;
  }
  if (!has_buttons) return part;
  state.buttons = mask;
  return part == SpaceMousePart::kNothing ? SpaceMousePart::kButtons : part;
}

std::unique_ptr<Driver> make_spacemouse(PortOpener opener, SecondsClock clock) {
  return std::make_unique<SpaceMouse>(std::move(opener), std::move(clock));
}

Status register_spacemouse() {
  return register_driver(
      "spacemouse",
      [] { return make_spacemouse([](const std::string& id) { return open_hid(kSpacemouseMatches, id); }); },
      list_spacemice);
}

}  // namespace pliant
