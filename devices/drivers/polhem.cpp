#include "devices/drivers/polhem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "devices/ports/hid_descriptor.h"
#include "devices/ports/hid_port.h"

namespace pliant {
namespace {

constexpr const char* kKeys[] = {"mechanism", "home"};
constexpr const char* kHomes[] = {"button", "here", "kept"};
constexpr int kMostCounts = 400;  // largest change of a motor's counts per millisecond: 12,000 rpm at 2000 counts per
                                  // turn
constexpr int kNearHome = 100;    // counts: tolerance for the arm's motion while its encoders were set
constexpr int kAskAgain = 20;     // reports after which setting the encoders is repeated
const HidMatch kPolhemMatches[] = {{0x16c0, {0x0486}}};

std::string mechanisms() {
  std::string names;
  for (const PolhemConfig& config : kPolhemConfigs) names += (names.empty() ? "" : ", ") + std::string(config.name);
  return names;
}

DeviceCapabilities what_it_can(const PolhemConfig& config) {
  return {.senses_rotation = config.turn_counts.x > 0.0,
          .max_force = config.max_force,
          .max_stiffness = config.max_stiffness,
          .workspace = dvec3(config.radius),
          .rate = 1000.0,
          .latency = 0.002,
          .loop = DeviceLoop::kReply};
}

void put16(std::span<std::uint8_t> bytes, std::size_t at, int value) {
  const auto bits = static_cast<std::uint16_t>(std::clamp(value, -32768, 32767));
  bytes[at] = static_cast<std::uint8_t>(bits);
  bytes[at + 1] = static_cast<std::uint8_t>(bits >> 8);
}

class Polhem final : public Driver {
 public:
  Polhem(PortOpener opener, SecondsClock clock) : opener_(std::move(opener)), clock_(std::move(clock)) {}
  ~Polhem() override { Polhem::close(); }

  Status open(const std::string& id) override {
    close();
    const Result<DeviceWords> words = parse_device_words("polhem", id, kKeys);
    if (!words) return words.error();
    const std::string wanted = words->text("mechanism", "");
    config_ = nullptr;
    for (const PolhemConfig& config : kPolhemConfigs)
      if (wanted == config.name) config_ = &config;
    const std::string where = "device `polhem:" + id + "`";
    if (!config_)
      return Error{where,
                   fmt::format("{}", wanted.empty() ? "the device cannot say which build it is"
                                                    : "unknown mechanism '" + wanted + "'"),
                   fmt::format("say polhem:{}?mechanism=NAME with NAME one of {}", words->id, mechanisms())};
    const Result<std::string> home = choice_of("polhem", *words, "home", kHomes);
    if (!home) return home.error();
    Result<std::unique_ptr<PacketPort>> port = opener_(words->id);
    if (!port) return port.error();
    port_ = std::move(*port);
    length_ = kPolhemOutput;
    if (const Result<HidLayout> layout = parse_hid_descriptor(port_->descriptor()); layout)
      if (const std::size_t bytes = layout->bytes(HidKind::kOutput, 0); bytes >= 14 && bytes < kPolhemOutput)
        length_ = bytes + 1;
    gone_ = fresh_ = placed_ = set_ = false;
    calibrated_ = *home == "kept";
    input_ = {};
    jumps_ = asked_ = 0;
    here_ = *home == "here";
    by_button_ = *home == "button";
    drive(dvec3(0));  // the first report starts the device
    if (gone_) return Error{where, "does not take a report", "plug it in again"};
    return Done{};
  }
  DeviceCapabilities capabilities() const override { return what_it_can(config_ ? *config_ : kPolhemConfigs[0]); }

  bool read(DeviceSample& sample) override {
    while (receive(0.0)) {
    }
    if (!fresh_ || gone_) return false;
    fresh_ = false;
    const PolhemPose pose = polhem_pose(*config_, input_.counts);
    sample = {};
    sample.position = pose.position;
    sample.rotation = pose.rotation;
    sample.ready = calibrated_;
    sample.buttons = input_.button ? 1u : 0u;
    sample.time = sensed_at_;
    return true;
  }

  void write(const DeviceWrench& wrench) override {
    if (!port_ || gone_) return;
    if (!calibrated_ && !set_ && (here_ || (placed_ && input_.info != 0))) {
      set_encoders();
      return;
    }
    const bool force = calibrated_ && placed_;
    drive(force ? polhem_currents(*config_, polhem_angles(*config_, input_.counts), wrench.force) : dvec3(0));
  }
  void wait(double seconds) override {
    if (!fresh_) receive(seconds);
  }
  void make_safe() noexcept override {
    try {
      if (port_ && !gone_) drive(dvec3(0));
    } catch (...) {  // the device's own watchdog removes the force
    }
  }
  // The report with zero currents.
  bool safe_line(SafeLine& line) const override {
    if (!port_ || gone_ || port_->file() < 0) return false;
    std::array<std::uint8_t, kPolhemOutput> report;
    polhem_drive(dvec3(0), report);
    std::copy_n(report.begin(), length_, line.bytes.begin());
    line.size = length_;
    line.descriptor = port_->file();
    return true;
  }
  std::string node() const override { return port_ ? port_->node() : std::string(); }
  // One that was said to be parked when it was opened, or whose encoders were said to be right, is not so any more.
  bool gone() const override { return gone_ && by_button_; }
  void close() override {
    make_safe();
    port_.reset();
  }

 private:
  // Receives at most one report within `seconds`.
  bool receive(double seconds) {
    if (!port_ || gone_) return false;
    std::array<std::uint8_t, 64> packet;
    const Result<std::size_t> length = port_->receive(packet, seconds);
    gone_ = !length;
    if (gone_ || *length == 0) return false;
    PolhemInput input;
    if (!parse_polhem({packet.data(), *length}, input)) return true;  // dropped
    const double now = clock_();
    if (set_ && at_home(input)) {
      set_ = placed_ = false;
      calibrated_ = true;
    } else if (set_ && ++asked_ > kAskAgain) {
      set_ = false;
    }
    if (placed_ && !plausible(input, now)) return true;
    jumps_ = 0;
    input_ = input;
    placed_ = fresh_ = true;
    sensed_at_ = asked_at_;
    return true;
  }

  bool at_home(const PolhemInput& input) const {
    bool near = input.info == 0;
    for (std::size_t i = 0; i < 3; ++i) near = near && std::abs(input.counts[i] - config_->home[i]) < kNearHome;
    return near;
  }

  // A jump is an invalid report. If it persists, the encoders were set by another program, and the pose is unknown.
  bool plausible(const PolhemInput& input, double now) {
    const double most = kMostCounts * std::max(1.0, 1000.0 * (now - sensed_at_));
    bool leaps = false;
    for (std::size_t i = 0; i < 3; ++i) leaps = leaps || std::abs(input.counts[i] - input_.counts[i]) > most;
    if (leaps && ++jumps_ < 5) return false;
    if (leaps) calibrated_ = here_ = false;
    return true;
  }

  void set_encoders() {
    std::array<std::uint8_t, kPolhemOutput> report;
    polhem_set_encoders(config_->home, report);
    asked_at_ = clock_();
    gone_ = !port_->send(std::span(report).first(length_));
    set_ = true;
    asked_ = 0;
  }
  void drive(const dvec3& currents) {
    std::array<std::uint8_t, kPolhemOutput> report;
    polhem_drive(currents, report);
    asked_at_ = clock_();
    gone_ = !port_->send(std::span(report).first(length_));
  }

  PortOpener opener_;
  SecondsClock clock_;
  std::unique_ptr<PacketPort> port_;
  const PolhemConfig* config_ = nullptr;
  std::size_t length_ = kPolhemOutput;
  PolhemInput input_;
  double asked_at_ = 0.0;   // when the last report was sent
  double sensed_at_ = 0.0;  // when the arm sampled `input_`: at the previous report
  int jumps_ = 0, asked_ = 0;
  bool here_ = false;  // the arm was parked when opened
  bool gone_ = false, fresh_ = false, placed_ = false, set_ = false, calibrated_ = false;
  bool by_button_ = false;
};

std::vector<DeviceInfo> list_polhems() {
  std::vector<DeviceInfo> infos;
  for (const HidFound& found : find_hid(kPolhemMatches))
    infos.push_back({"polhem", found.id, found.name,
                     !found.missing.empty()
                         ? found.missing
                         : fmt::format("it cannot say which build it is; name it as polhem:{}?mechanism="
                                       "NAME with NAME one of {}",
                                       found.id, mechanisms()),
                     what_it_can(kPolhemConfigs[0])});
  return infos;
}

}  // namespace

bool parse_polhem(std::span<const std::uint8_t> report, PolhemInput& input) {
  if (report.size() < 14) return false;
  const auto s16 = [&](std::size_t i) { return static_cast<std::int16_t>(report[2 * i] | report[2 * i + 1] << 8); };
  for (std::size_t i = 0; i < 6; ++i) input.counts[i] = s16(i);
  input.info = s16(6);
  input.button = input.counts[3] > 5000;
  if (input.button) input.counts[3] = static_cast<std::int16_t>(input.counts[3] - 10000);
  return true;
}

void polhem_drive(const dvec3& currents, std::span<std::uint8_t, kPolhemOutput> into) {
  std::fill(into.begin(), into.end(), std::uint8_t(0));
  for (int motor = 0; motor < 3; ++motor) {
    const double milliamperes = 1000.0 * currents[motor];
    put16(into, 1 + 2 * static_cast<std::size_t>(motor),
          std::isfinite(milliamperes) ? static_cast<int>(std::clamp(milliamperes, -32767.0, 32767.0)) : 0);
  }
}

void polhem_set_encoders(const std::array<int, 6>& counts, std::span<std::uint8_t, kPolhemOutput> into) {
  std::fill(into.begin(), into.end(), std::uint8_t(0));
  for (std::size_t i = 0; i < 3; ++i) {
    put16(into, 9 + 2 * i, counts[i]);
    put16(into, 1 + 2 * i, counts[i + 3]);  // the current fields, unused by this command
  }
  put16(into, 7, 1);
}

std::unique_ptr<Driver> make_polhem(PortOpener opener, SecondsClock clock) {
  return std::make_unique<Polhem>(std::move(opener), std::move(clock));
}

Status register_polhem() {
  return register_driver(
      "polhem", [] { return make_polhem([](const std::string& id) { return open_hid(kPolhemMatches, id); }); },
      list_polhems);
}

}  // namespace pliant
