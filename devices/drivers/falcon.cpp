#include "devices/drivers/falcon.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "devices/drivers/falcon_delta.h"
#include "devices/ports/usb_port.h"

namespace pliant {
namespace {

constexpr std::uint16_t kVendor = 0x0403, kProduct = 0xcb48;
constexpr double kFalconPeriod = 1e-3;  // [s] between two exchanges
constexpr double kFalconRetry = 0.5;    // [s] between two reconnection attempts
constexpr int kSilentUntilLost = 50;    // exchanges without an answer, after which the device is lost
constexpr int kTries = 10;              // attempts to load the firmware, which often fails the first time
constexpr std::size_t kBlock = 128;     // bytes of firmware per block, sent and echoed
constexpr std::size_t kMostFirmware = 1 << 20;
constexpr double kCountsPerTorque = 10000.0;  // [1/(N m)] of a motor's command, which has the opposite sign
constexpr int kMostTorque = 4095;             // limit of a motor's command
constexpr dvec3 kMiddle{0.0, 0.0, 0.125};     // [m] of the workspace
constexpr unsigned kRed = 2, kGreen = 4, kAllHomed = 7;

// Requests of the FTDI chip.
enum Request : std::uint8_t { kResetChip = 0, kModem = 1, kFlow = 2, kBaud = 3, kData = 4, kLatency = 9 };
struct Setting {
  Request request;
  std::uint16_t value;
};
constexpr Setting kPurgeIn{kResetChip, 1}, kPurgeOut{kResetChip, 2};
constexpr Setting kToBoot[] = {kPurgeIn,   kPurgeOut,        {kLatency, 16},   {kBaud, 0x4138}, {kData, 8},
                               {kFlow, 0}, {kModem, 0x0200}, {kModem, 0x0100}, {kModem, 0x0101}};
constexpr Setting kToLoad[] = {{kModem, 0x0100}, {kBaud, 0x15}};
constexpr Setting kToRun[] = {{kLatency, 1}, {kBaud, 2}, kPurgeIn, kPurgeOut};

template <std::size_t N>
Status set(PacketPort& port, const Setting (&settings)[N]) {
  for (const auto& [request, value] : settings) {
    const std::uint8_t bytes[] = {request, static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8), 0,
                                  0};
    if (auto done = port.set_feature(bytes); !done) return done;
  }
  return Done{};
}

// Time-out that also counts empty packets: time alone would count a busy machine's pauses as the device's.
class Patience {
 public:
  explicit Patience(double seconds) : end_(DeviceThread::seconds() + seconds) {}
  // Called for a packet without bytes, or no packet. False: stop waiting.
  bool empty() { return ++empties_ < 8 || DeviceThread::seconds() < end_; }

 private:
  double end_;
  int empties_ = 0;
};
constexpr double kPacket = 0.002;  // [s] the chip sends one a millisecond, with bytes or without

// All bytes received within `seconds`, at most `most`, without the two modem status bytes of each packet.
std::vector<std::uint8_t> hear(PacketPort& port, std::size_t most, double seconds) {
  std::vector<std::uint8_t> all;
  for (Patience patience(seconds); all.size() < most;) {
    std::uint8_t packet[64];
    const auto got = port.receive(packet, kPacket);
    if (!got) break;
    if (*got > 2)
      all.insert(all.end(), packet + 2, packet + *got);
    else if (!patience.empty())
      break;
  }
  return all;
}

bool answers(PacketPort& port, std::span<const std::uint8_t> ask, std::initializer_list<std::uint8_t> expected) {
  if (!port.send(ask)) return false;
  const auto got = hear(port, expected.size(), 0.2);
  return std::equal(got.begin(), got.end(), expected.begin(), expected.end());
}

bool load(PacketPort& port, std::span<const std::uint8_t> firmware) {
  constexpr std::uint8_t kHello[] = {0x0A, 0x43, 0x0D}, kBegin[] = {0x41};
  if (!set(port, kToBoot) || !answers(port, kHello, {0x0A, 0x44, 0x2C, 0x0D})) return false;
  if (!set(port, kToLoad) || !answers(port, kBegin, {0x41})) return false;
  for (std::size_t at = 0; at < firmware.size(); at += kBlock) {
    const auto block = firmware.subspan(at, std::min(kBlock, firmware.size() - at));
    if (!port.send(block)) return false;
    const auto echo = hear(port, block.size(), 0.5);
    if (!std::equal(echo.begin(), echo.end(), block.begin(), block.end())) return false;
  }
  return true;
}

// The given file, or the user's default.
std::string firmware_path(const std::string& id) {
  if (!id.empty()) return id;
  const char* data = std::getenv("XDG_DATA_HOME");
  const char* home = std::getenv("HOME");
  return (data ? std::string(data) : std::string(home ? home : ".") + "/.local/share") + "/pliant/falcon.bin";
}

}  // namespace

FalconFrame falcon_command(const std::array<int, 3>& torque, bool homing, unsigned lights) {
  FalconFrame frame;
  frame.fill(0x41);
  frame.front() = '<';
  frame.back() = '>';
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t nibble = 0; nibble < 4; ++nibble)  // lowest nibble first
      frame[1 + 4 * i + nibble] =
          static_cast<std::uint8_t>(0x41 + (static_cast<unsigned>(torque[i]) >> 4 * nibble & 15u));
  frame[13] = static_cast<std::uint8_t>(0x41 + ((lights & 14u) | (homing ? 1u : 0u)));
  return frame;
}

std::optional<FalconReport> parse_falcon(std::span<const std::uint8_t> bytes) {
  std::optional<FalconReport> last;
  for (std::size_t at = 0; at + kFalconFrame <= bytes.size(); ++at) {
    const auto frame = bytes.subspan(at, kFalconFrame);
    if (frame.front() != '<' || frame.back() != '>') continue;
    FalconReport report;
    bool whole = frame[13] >= 0x41 && frame[13] < 0x41 + 0x80;
    for (std::size_t i = 0; i < 3; ++i) {
      unsigned bits = 0;
      for (std::size_t nibble = 0; nibble < 4; ++nibble) {
        const unsigned letter = frame[1 + 4 * i + nibble] - 0x41u;
        whole = whole && letter < 16;
        bits |= (letter & 15u) << 4 * nibble;
      }
      report.count[i] = static_cast<std::int16_t>(bits);
    }
    if (!whole) continue;
    const unsigned status = frame[13] - 0x41u;
    report.homed = status >> 4 & 7u;
    report.buttons = status & 15u;
    last = report;
    at += kFalconFrame - 1;
  }
  return last;
}

std::array<int, 3> falcon_motors(const dvec3& position, const dvec3& force) {
  FalconPose pose;
  dvec3 torque;
  if (!falcon_angles(position, pose) || !falcon_torques(pose, force, torque)) return {};
  dvec3 number = -kCountsPerTorque * torque;
  const double largest = std::max({std::abs(number.x), std::abs(number.y), std::abs(number.z)});
  if (!std::isfinite(largest)) return {};
  if (largest > kMostTorque) number *= kMostTorque / largest;
  // Truncates towards zero, so that rounding adds no force.
  return {static_cast<int>(number.x), static_cast<int>(number.y), static_cast<int>(number.z)};
}

Falcon::Falcon()
    : Falcon([](const std::string&) -> Result<std::unique_ptr<PacketPort>> {
        auto port = UsbPort::open({kVendor, kProduct, 0x02, 0x81, 0});
        if (!port) return port.error();
        return std::unique_ptr<PacketPort>(std::move(*port));
      }) {}
Falcon::Falcon(PortOpener opener) : opener_(std::move(opener)) {}
Falcon::~Falcon() {
  close();
}

DeviceCapabilities Falcon::capabilities() const {
  return {.max_force = 8.0,
          .max_stiffness = 3000.0,
          .workspace = {0.05, 0.05, 0.05},
          .rate = 1.0 / kFalconPeriod,
          .latency = 2e-3};
}

Falcon::Answer Falcon::exchange(PacketPort& port, const std::array<int, 3>& torque, bool homing,
                                FalconReport& report) const {
  if (!port.send(falcon_command(torque, homing, homing ? kRed : kGreen))) return Answer::kGone;
  std::array<std::uint8_t, 256> stream;
  std::size_t size = 0;
  for (Patience patience(0.01);;) {
    std::uint8_t packet[64];
    const auto got = port.receive(packet, kPacket);
    if (!got) return Answer::kGone;
    if (*got <= 2) {
      if (!patience.empty()) return Answer::kNone;
      continue;
    }
    const std::size_t taken = std::min(*got - 2, stream.size() - size);
    std::copy_n(packet + 2, taken, stream.begin() + static_cast<long>(size));
    size += taken;
    if (const auto found = parse_falcon(std::span(stream).first(size))) {
      report = *found;
      return Answer::kReport;
    }
    if (size == stream.size()) return Answer::kNone;  // noise
  }
}

// Opens a connection to a device with running firmware; loads the firmware if needed.
Result<std::unique_ptr<PacketPort>> Falcon::connect(const std::vector<std::uint8_t>& firmware) const {
  auto port = opener_("");
  if (!port) return port.error();
  FalconReport report;
  const auto runs = [&] {
    if (!set(**port, kToRun)) return false;
    for (int i = 0; i < 3; ++i)
      if (exchange(**port, {}, true, report) == Answer::kReport) return true;
    return false;
  };
  bool running = runs();
  for (int i = 0; i < kTries && !running && !firmware.empty(); ++i) running = load(**port, firmware) && runs();
  if (running) return port;
  if (!firmware.empty())
    return Error{"falcon", "does not take its firmware in " + std::to_string(kTries) + " tries",
                 "take its power off for a moment, and see that the file is the Falcon's"};
  return Error{"falcon", "its firmware is not loaded"};
}

Status Falcon::open(const std::string& id) {
  close();
  const std::string path = firmware_path(id);
  firmware_.clear();
  if (std::ifstream file(path, std::ios::binary); file && std::filesystem::is_regular_file(path)) {
    firmware_.resize(kMostFirmware + 1);
    file.read(reinterpret_cast<char*>(firmware_.data()), static_cast<std::streamsize>(firmware_.size()));
    firmware_.resize(static_cast<std::size_t>(file.gcount()));
    if (firmware_.size() > kMostFirmware || firmware_.empty())
      return Error{path, "is no firmware of a Falcon, which has up to a megabyte", "give the maker's file"};
  } else if (!id.empty()) {
    return Error{path, "cannot be read", "give the maker's firmware file of the Falcon as `falcon:FILE`"};
  }
  auto port = connect(firmware_);
  if (!port && firmware_.empty() && port.error().where == "falcon")
    return Error{"falcon", "its firmware is not loaded, and " + path + " is not there",
                 "put the maker's firmware file there, or give it as `falcon:FILE`"};
  if (!port) return port.error();
  port_ = std::move(*port);
  thread_.start([this] { run(); });
  return Done{};
}

// Runs until close(); returns false if the connection is lost.
bool Falcon::talk() {
  dvec3 position = kMiddle;
  bool known = false, homing = true;
  int silent = 0;
  double due = DeviceThread::seconds();
  for (;;) {
    const bool last = thread_.stopping();
    const std::array<int, 3> motors =
        known && !last ? falcon_motors(position, thread_.wanted().force) : std::array<int, 3>{};
    FalconReport report;
    const Answer answer = exchange(*port_, motors, homing, report);
    if (last) return true;
    if (answer == Answer::kGone) return false;
    if (answer == Answer::kNone) {
      known = false;  // so the next command has zero force
      if (++silent > kSilentUntilLost) return false;
      continue;
    }
    silent = 0;
    homing = report.homed != kAllHomed;
    const dvec3 angle(falcon_angle(report.count[0]), falcon_angle(report.count[1]), falcon_angle(report.count[2]));
    known = !homing && (falcon_position(angle, position) || falcon_position(angle, position = kMiddle));
    DeviceSample sample;
    sample.position = known ? position - kMiddle : dvec3(0);
    sample.buttons = report.buttons;
    sample.ready = known;
    thread_.publish(sample);
    due = std::max(due + kFalconPeriod, DeviceThread::seconds());
    DeviceThread::sleep(due - DeviceThread::seconds());
  }
}

void Falcon::run() {
  while (!talk()) {
    port_.reset();
    while (!port_ && !thread_.stopping()) {
      DeviceThread::sleep(kFalconRetry);
      if (auto port = connect(firmware_)) port_ = std::move(*port);
    }
    if (!port_) return;
  }
}

void Falcon::close() {
  thread_.stop();
  port_.reset();
}

std::vector<DeviceInfo> list_falcon() {
  DeviceInfo info{.driver = "falcon", .name = "Novint Falcon", .can = Falcon().capabilities()};
  if (UsbPort::count(kVendor, kProduct) == 0)
    info.missing = "none is plugged in (USB 0403:cb48)";
  else if (auto port = UsbPort::open({kVendor, kProduct, 0x02, 0x81, 0}); !port)
    info.missing = port.error().message();
  else if (const std::string path = firmware_path(""); std::filesystem::is_regular_file(path))
    info.id = path;
  else
    info.missing = path + " is not there; put the maker's firmware file there, or open it as `falcon:FILE`";
  return {info};
}

}  // namespace pliant
