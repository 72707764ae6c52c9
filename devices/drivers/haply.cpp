#include "devices/drivers/haply.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "devices/ports/web_socket_port.h"

namespace pliant {
namespace {

using nlohmann::json;

constexpr int kPort = 10001;
constexpr std::size_t kLongestMessage = 256 * 1024;  // limit of a message in bytes; an inventory of ten devices has 20
                                                     // KiB
constexpr double kHaplyPeriod = 1e-3;                // [s] between two messages
constexpr double kAnswerTimeout = 0.5;               // [s] without an answer: the service is unresponsive
constexpr double kHaplyRetry = 0.25;                 // [s] between two reconnection attempts
constexpr double kMostReach = 2.0;                   // [m] position limit; the arm is 30 cm long

const json* find(const json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

bool number(const json& object, const char* key, double most, double& value) {
  const json* found = find(object, key);
  if (!found || !found->is_number()) return false;
  value = found->get<double>();
  return std::isfinite(value) && std::abs(value) <= most;
}

// Converts x, y, z of the service to world axes.
bool vector(const json* object, double most, dvec3& v) {
  dvec3 s;
  if (!object || !number(*object, "x", most, s.x) || !number(*object, "y", most, s.y) ||
      !number(*object, "z", most, s.z))
    return false;
  v = {s.x, s.z, -s.y};
  return true;
}

bool rotation(const json* object, dquat& q) {
  dvec3 axis;
  double w = 0.0;
  if (!vector(object, 1.1, axis) || !number(*object, "w", 1.1, w)) return false;
  const dquat read(w, axis.x, axis.y, axis.z);
  const double norm = glm::length(read);
  if (std::abs(norm - 1.0) > 0.05) return false;
  q = read / norm;
  return true;
}

std::string text(const json* value) {
  return value && value->is_string() ? value->get<std::string>() : std::string();
}

// The entry with this identifier in a list of devices; for "", the first.
const json* entry(const json& message, const char* kind, const std::string& wanted) {
  const json* list = find(message, kind);
  if (!list || !list->is_array()) return nullptr;
  for (const json& device : *list)
    if (wanted.empty() || text(find(device, "device_id")) == wanted) return &device;
  return nullptr;
}

Result<std::unique_ptr<PacketPort>> open_service(const std::string&) {
  auto port = WebSocketPort::connect("localhost", kPort, 2.0, kLongestMessage);
  if (!port)
    return Error{"haply", "the Inverse Service is not there (" + port.error().message() + ")",
                 "install Haply's Inverse Service or Hub and start it"};
  return std::unique_ptr<PacketPort>(std::move(*port));
}

}  // namespace

Result<HaplyState> parse_haply(std::string_view message, const std::string& wanted) {
  const Error damaged{"haply", "the service sent no JSON of a state", "see what else is on its port"};
  const Error false_numbers{"haply", "the service sent a pose whose numbers cannot be"};
  const json all = json::parse(message, nullptr, false);
  if (all.is_discarded() || !all.is_object()) return damaged;
  HaplyState state;
  state.sample.ready = false;
  const json* device = entry(all, "inverse3", wanted);
  if (!device) return state;
  state.device = text(find(*device, "device_id"));
  const json* of = find(*device, "state");
  if (const json* position = of ? find(*of, "cursor_position") : nullptr) {
    if (!vector(position, kMostReach, state.sample.position)) return false_numbers;
    state.sample.ready = true;
  }
  if (const json* velocity = of ? find(*of, "cursor_velocity") : nullptr)
    if (!vector(velocity, 1e3, state.velocity)) return false_numbers;
  if (const json* status = find(*device, "status"))
    for (const char* condition : {"ready", "calibrated", "power_supply"})
      if (const json* is = find(*status, condition); is && is->is_boolean() && !is->get<bool>())
        state.sample.ready = false;
  for (const char* kind : {"wireless_verse_grip", "verse_grip"}) {
    const json* grip = entry(all, kind, "");
    const json* grip_state = grip ? find(*grip, "state") : nullptr;
    if (!grip_state || state.has_grip) continue;
    if (!rotation(find(*grip_state, "orientation"), state.sample.rotation)) return false_numbers;
    state.has_grip = true;
    if (const json* buttons = find(*grip_state, "buttons"))
      for (unsigned i = 0; i < 3; ++i) {
        const char name[] = {static_cast<char>('a' + i), 0};
        const json* down = find(*buttons, name);
        if (down && down->is_boolean() && down->get<bool>()) state.sample.buttons |= 1u << i;
      }
  }
  return state;
}

std::string haply_command(const std::string& device, const dvec3& force, bool first) {
  // Converts world axes to the service's.
  return fmt::format(
      R"({{{}"inverse3":[{{"device_id":{},"commands":{{"set_cursor_force":{{"values":{{"x":{:.5f},"y":{:.5f},"z":{:.5f}}}}}}}}}]}})",
      first ? R"("session":{"configure":{"profile":{"name":"Pliant"}}},)" : "",
      json(device).dump(-1, ' ', true, json::error_handler_t::replace), force.x, -force.z, force.y);
}

Haply::Haply() : Haply(open_service) {}
Haply::Haply(PortOpener opener) : opener_(std::move(opener)) {}
Haply::~Haply() {
  close();
}

DeviceCapabilities Haply::capabilities() const {
  // The service reports neither force nor stiffness: these are deliberately below the vendor's figures.
  return {.senses_rotation = has_grip_,
          .max_force = 4.0,
          .max_stiffness = 1000.0,
          .rate = 1.0 / kHaplyPeriod,
          .latency = 2.0 * kHaplyPeriod};
}

Status Haply::open(const std::string& id) {
  close();
  auto port = opener_(id);
  if (!port) return port.error();
  std::vector<std::uint8_t> bytes(kLongestMessage);
  const auto got = (*port)->receive(bytes, 2.0);  // the inventory, which the service sends first
  if (!got) return got.error();
  const auto state = parse_haply({reinterpret_cast<const char*>(bytes.data()), *got}, id);
  if (!state) return state.error();
  if (state->device.empty())
    return id.empty()
               ? Error{"haply", "the Inverse Service has no Inverse3", "plug it in and switch it on", "device.missing"}
               : Error{"haply", "the Inverse Service has no Inverse3 called `" + id + "`", "see `pliant devices`",
                       "device.missing"};
  wanted_ = state->device;
  has_grip_ = state->has_grip;
  port_ = std::move(*port);
  refused_ = restarts_ = 0;
  safe_file_.keep(port_->file());
  thread_.start([this] { run(); });
  return Done{};
}

// Exchanges messages until close(); returns false if the connection is lost.
bool Haply::talk(PacketPort& port) {
  std::vector<std::uint8_t> bytes(kLongestMessage);
  bool first = true;
  double due = DeviceThread::seconds();
  for (;;) {
    const bool last = thread_.stopping();  // the last message has zero force
    const std::string command = haply_command(wanted_, thread_.wanted().force, first);
    first = false;
    if (!port.send({reinterpret_cast<const std::uint8_t*>(command.data()), command.size()})) return false;
    const auto got = port.receive(bytes, kAnswerTimeout);
    if (last) return true;  // answered, so it was received
    if (!got || *got == 0) return false;
    const auto state = parse_haply({reinterpret_cast<const char*>(bytes.data()), *got}, wanted_);
    if (!state) {
      ++refused_;
    } else if (!state->device.empty()) {
      thread_.publish(state->sample);
    }
    due = std::max(due + kHaplyPeriod, DeviceThread::seconds());
    DeviceThread::sleep(due - DeviceThread::seconds());
  }
}

void Haply::run() {
  while (!talk(*port_)) {
    port_.reset();
    safe_file_.lose();
    while (!port_ && !thread_.stopping()) {
      DeviceThread::sleep(kHaplyRetry);
      auto port = opener_(wanted_);
      if (!port) continue;
      std::uint8_t inventory[64];  // discards the rest of an inventory
      if (const auto got = (*port)->receive(inventory, 1.0); !got || *got == 0) continue;
      port_ = std::move(*port);
      safe_file_.keep(port_->file());
      ++restarts_;
    }
    if (!port_) return;
  }
}

bool Haply::read(DeviceSample& sample) {
  return thread_.read(sample);
}
void Haply::write(const DeviceWrench& wrench) {
  thread_.write(wrench);
}

void Haply::close() {
  thread_.stop();
  port_.reset();
  safe_file_.close();
}

bool Haply::safe_line(SafeLine& line) const {
  if (safe_file_.number() < 0) return false;
  const std::string command = haply_command(wanted_, dvec3(0), false);
  line.size = web_socket_frame({reinterpret_cast<const std::uint8_t*>(command.data()), command.size()}, line.bytes);
  line.descriptor = safe_file_.number();
  return line.size > 0;
}

std::vector<DeviceInfo> list_haply() {
  DeviceInfo info{.driver = "haply", .name = "Haply Inverse3", .can = Haply().capabilities()};
  auto port = WebSocketPort::connect("localhost", kPort, 0.2, kLongestMessage);
  std::vector<std::uint8_t> bytes(kLongestMessage);
  const auto got = port ? (*port)->receive(bytes, 0.5) : Result<std::size_t>(port.error());
  if (!got) {
    info.missing = "the Inverse Service is not running; install Haply's Inverse Service or Hub and start it";
    return {info};
  }
  const auto state = parse_haply({reinterpret_cast<const char*>(bytes.data()), *got}, "");
  if (!state)
    info.missing = state.error().sentence();
  else if (state->device.empty())
    info.missing = "the Inverse Service has no Inverse3; plug it in and switch it on";
  else
    info.id = state->device;
  return {info};
}

}  // namespace pliant
