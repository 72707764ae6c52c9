#include "devices/drivers/serial_device.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "devices/ports/serial_port.h"

namespace pliant {
namespace {

constexpr double kSerialPeriod = 1e-3;  // [s] between two exchanges; the connection may make it longer
constexpr double kSerialAnswer = 0.02;  // [s] wait for a pose before the next force
constexpr double kSerialRetry = 0.5;    // [s] between two reconnection attempts
constexpr int kSerialSilentUntilLost = 100;
constexpr double kBoot = 4.0;  // [s] an Arduino resets when its port is opened

Result<std::unique_ptr<PacketPort>> open_line(const std::string& id) {
  const std::size_t at = id.rfind('@');
  int baud = 115200;
  if (at != std::string::npos) {
    const char* end = id.data() + id.size();
    const auto [stop, fault] = std::from_chars(id.data() + at + 1, end, baud);
    if (fault != std::errc() || stop != end)
      return Error{"serial `" + id + "`", "has no speed after '@'", "give one such as 115200"};
  }
  auto port = SerialPort::open(id.substr(0, at), baud);
  if (!port) return port.error();
  return std::unique_ptr<PacketPort>(std::move(*port));
}

Status send(PacketPort& port, std::string_view text) {
  return port.send({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

// Receives for up to `seconds`. Error: the connection is lost.
Status hear(PacketPort& port, SerialLines& lines, double seconds) {
  std::uint8_t bytes[256];
  const auto got = port.receive(bytes, seconds);
  if (!got) return got.error();
  lines.add({reinterpret_cast<const char*>(bytes), *got});
  return Done{};
}

}  // namespace

SerialDevice::SerialDevice() : SerialDevice(open_line) {}
SerialDevice::SerialDevice(PortOpener opener) : opener_(std::move(opener)) {}
SerialDevice::~SerialDevice() {
  close();
}

Result<SerialIdentity> SerialDevice::ask(PacketPort& port, const std::function<bool()>& stop) const {
  SerialLines lines;
  for (const double end = DeviceThread::seconds() + kBoot; DeviceThread::seconds() < end && !stop();) {
    if (auto done = send(port, serial_question()); !done) return done.error();
    for (const double until = DeviceThread::seconds() + 0.2; DeviceThread::seconds() < until;) {
      if (auto done = hear(port, lines, 0.05); !done) return done.error();
      for (std::string_view line; lines.next(line);)
        if (auto who = parse_serial_identity(line)) return std::move(*who);
    }
  }
  return Error{"serial `" + id_ + "`", "does not answer as a device of Pliant",
               "see docs/devices/protocols.md for its lines, and check its speed"};
}

Status SerialDevice::open(const std::string& id) {
  close();
  id_ = id;
  if (id.empty())
    return Error{"serial", "needs its line", "give one such as serial:/dev/ttyACM0, see `pliant devices`"};
  auto port = opener_(id);
  if (!port) return port.error();
  auto who = ask(**port, [] { return false; });
  if (!who) return who.error();
  identity_ = std::move(*who);
  can_ = {.renders_force = identity_.axes > 0,
          .max_force = identity_.max_force,
          .max_stiffness = 500.0,  // stable on such boards at these rates
          .senses_grip = true,
          .rate = 1.0 / kSerialPeriod,
          .latency = 2e-3};
  port_ = std::move(*port);
  too_short_ = sums_ = forms_ = numbers_ = 0;
  safe_file_.keep(port_->file());
  thread_.start([this] { run(); });
  return Done{};
}

// Runs until close(); returns false if the connection is lost.
bool SerialDevice::talk() {
  SerialLines lines;
  unsigned number = 0;
  int silent = 0;
  double due = DeviceThread::seconds();
  for (;;) {
    const bool last = thread_.stopping();
    dvec3 force = silent > 0 ? dvec3(0) : thread_.wanted().force;  // zero force without answers
    for (int i = identity_.axes; i < 3; ++i) force[i] = 0.0;
    SerialText text;
    const std::size_t length = serial_force(++number, force, text);
    if (!send(*port_, {text.data(), length})) return false;
    if (last) return true;
    bool came = false;
    for (const double end = DeviceThread::seconds() + kSerialAnswer; !came && DeviceThread::seconds() < end;) {
      if (!hear(*port_, lines, end - DeviceThread::seconds())) return false;
      for (std::string_view line; lines.next(line);) {
        SerialFault fault = SerialFault::kNone;
        const auto pose = parse_serial_pose(line, &fault);
        count(fault);
        if (!pose) continue;
        thread_.publish(pose->sample);
        came = true;
      }
    }
    silent = came ? 0 : silent + 1;
    if (silent > kSerialSilentUntilLost) return false;
    due = std::max(due + kSerialPeriod, DeviceThread::seconds());
    DeviceThread::sleep(due - DeviceThread::seconds());
  }
}

void SerialDevice::run() {
  while (!talk()) {
    port_.reset();
    safe_file_.lose();
    while (!port_ && !thread_.stopping()) {
      DeviceThread::sleep(kSerialRetry);
      auto port = opener_(id_);
      if (port && ask(**port, [this] { return thread_.stopping(); })) port_ = std::move(*port);
    }
    if (!port_) return;
    safe_file_.keep(port_->file());
  }
}

void SerialDevice::close() {
  thread_.stop();
  port_.reset();
  safe_file_.close();
}

// A line of zero force; the leading end of line terminates a truncated line.
bool SerialDevice::safe_line(SafeLine& line) const {
  if (safe_file_.number() < 0) return false;
  SerialText text;
  const std::size_t length = serial_force(0, dvec3(0), text);
  line.descriptor = safe_file_.number();
  line.size = length + 1;
  line.bytes[0] = '\n';
  std::copy_n(text.begin(), length, line.bytes.begin() + 1);
  return true;
}

void SerialDevice::count(SerialFault fault) {
  switch (fault) {
    case SerialFault::kNone:
      return;
    case SerialFault::kTooShort:
      ++too_short_;
      return;
    case SerialFault::kSum:
      ++sums_;
      return;
    case SerialFault::kForm:
      ++forms_;
      return;
    case SerialFault::kNumber:
      ++numbers_;
      return;
  }
}

DroppedFrames SerialDevice::dropped() const {
  return {.too_short = too_short_, .unknown = forms_, .checksum = sums_, .number = numbers_};
}

std::vector<DeviceInfo> list_serial(const std::string& folder) {
  std::vector<DeviceInfo> found;
  std::error_code fault;
  for (const auto& entry : std::filesystem::directory_iterator(folder, fault)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("ttyACM") && !name.starts_with("ttyUSB")) continue;
    DeviceInfo info{.driver = "serial", .id = entry.path().string(), .name = "serial line " + name};
    if (access(entry.path().c_str(), R_OK | W_OK) != 0)
      info.missing =
          "may not be opened by this user; install the udev rule 70-pliant.rules and plug it in again, or join "
          "the group dialout";
    found.push_back(info);
  }
  std::sort(found.begin(), found.end(), [](const DeviceInfo& a, const DeviceInfo& b) { return a.id < b.id; });
  if (found.empty()) {
    DeviceInfo info{.driver = "serial", .name = "serial device"};
    info.missing = "no serial line of USB (ttyACM, ttyUSB) is plugged in";
    found.push_back(info);
  }
  return found;
}

}  // namespace pliant
