// Text about devices: pose files, profiles and keys of a simulated device, wrappers, requests, driver options. The
// first byte selects the parser. Accepted values must be finite, in range and usable; rejected ones must give a
// sentence.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "devices/choose.h"
#include "devices/drivers/device_words.h"
#include "devices/drivers/stick_control.h"
#include "devices/pose_file.h"
#include "devices/simulated/simulated_device.h"
#include "devices/spec.h"
#include "devices/wrappers/chain.h"
#include "runtime/assert.h"

namespace {

using namespace pliant;

bool finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class T>
bool taken(const Result<T>& result) {
  if (!result) ASSERT(!result.error().message().empty());
  return result.ok();
}

void poses(const std::string& text) {
  const auto rows = parse_poses(text, "poses.csv");
  if (!taken(rows)) return;
  ASSERT(!rows->empty());
  double before = -INFINITY;
  for (const PoseFileRow& row : *rows) {
    ASSERT(row.sample.time > before && std::isfinite(row.sample.time));
    before = row.sample.time;
    ASSERT(finite(row.sample.position) && finite(row.wrench.force) && finite(row.wrench.torque));
    ASSERT(std::abs(glm::length(row.sample.rotation) - 1.0) < 1e-9);
  }
  // A path gives a pose at any time.
  Path path = path_of(*rows);
  for (const bool repeats : {false, true}) {
    path.repeats = repeats;
    PathCursor cursor(path);
    const double first = path.rows.front().time, last = path.rows.back().time;
    for (const double at : {first - 1.0, first, 0.5 * (first + last), last, last + 1.0, first, 3.0 * last}) {
      const PathRow row = cursor.at(at);
      for (int i = 0; i < 3; ++i) ASSERT(!std::isnan(row.position[i]));
      ASSERT(std::abs(glm::length(row.rotation) - 1.0) < 1e-6);
    }
  }
}

// Files are covered by another target: text that names one is skipped.
bool names_a_file(const std::string& text) {
  for (const char* const key : {"path", "replay", "record"})
    if (text.find(key) != std::string::npos) return true;
  return false;
}

// Its samples must stay finite under any force.
void move(Driver& device) {
  for (int i = 0; i < 12; ++i) {
    DeviceSample sample;
    if (device.read(sample)) ASSERT(finite(sample.position) && std::isfinite(sample.grip));
    device.write({{i % 3 ? 1e300 : -0.5, i * 0.1, -1.0}, {0.1, 0, 0}, 1.0});
  }
}

void simulated(const std::string& text) {
  if (names_a_file(text)) return;
  auto options = parse_simulated(text);
  if (!taken(options)) return;
  const DeviceCapabilities can = capabilities_of(options->profile);
  for (const double limit : {can.max_force, can.max_stiffness, can.rate, can.latency, can.damping})
    ASSERT(limit >= 0.0 && std::isfinite(limit));
  if (options->profile.rate < 500.0) return;  // long periods make a run slow
  options->clock = DeviceClock::kTick;
  SimulatedDevice device(std::move(options).value());
  ASSERT(device.open("").ok());
  move(device);
}

void wrappers(const std::string& text) {
  if (names_a_file(text)) return;
  SimulatedOptions options;
  options.clock = DeviceClock::kTick;
  auto chain = wrap(std::make_unique<SimulatedDevice>(options), text);
  if (!taken(chain)) return;
  ASSERT(chain->driver->open("").ok());
  ASSERT(std::isfinite(chain->driver->capabilities().latency));
  move(*chain->driver);
  chain->driver->close();
}

void request(const std::string& text) {
  static const std::vector<DeviceInfo> there = [] {
    register_simulated();
    std::vector<DeviceInfo> all = list_devices();
    all.push_back({"falcon", "0", "Novint Falcon", "", {.max_force = 8.0}});
    all.push_back({"falcon", "1", "Novint Falcon", "its firmware is missing; load it", {}});
    return all;
  }();
  if (taken(choose_device(text, there))) return;
}

void words(const std::string& text) {
  static constexpr const char* kKeys[] = {"control", "speed", "turn", "dead_zone", "reach", "mechanism"};
  const auto parsed = parse_device_words("spacemouse", text, kKeys);
  if (!taken(parsed)) return;
  if (const auto stick = stick_settings("spacemouse", *parsed, {}); taken(stick))
    for (const double value : {stick->speed, stick->turn, stick->dead_zone, stick->reach}) ASSERT(std::isfinite(value));
}

void numbers(const std::string& text) {
  for (const auto read : {plain_number, seconds_of, metres_of, newtons_of, share_of})
    if (const auto value = read(text)) ASSERT(std::isfinite(*value));
  if (const auto v = vector_of(text)) ASSERT(finite(*v));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 6) {
    case 0:
      poses(text);
      break;
    case 1:
      simulated(text);
      break;
    case 2:
      wrappers(text);
      break;
    case 3:
      request(text);
      break;
    case 4:
      words(text);
      break;
    default:
      numbers(text);
      break;
  }
  return 0;
}
