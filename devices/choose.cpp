#include "devices/choose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "components/device_spec.h"
#include "devices/believable.h"

namespace pliant {
namespace {

constexpr const char* kNetworkDriver = "network";

bool pushes(const DeviceInfo& device) {
  return device.can.renders_force && !device.can.resists_only;
}
bool senses_a_pose(const DeviceInfo& device) {
  return device.can.senses_position && device.can.senses_rotation;
}

// The device with the wrappers of the request.
std::string wrapped(std::string device, const DeviceSpec& request) {
  for (const std::string& wrapper : request.wrappers) device += "|" + wrapper;
  return device;
}

// Of a kind; the strongest first.
Result<const DeviceInfo*> of_kind(const std::string& kind, std::span<const DeviceInfo> there) {
  const auto fits = [&](const DeviceInfo& device) {
    if (device.can.simulated) return false;  // simulated devices must be named explicitly
    return kind == "any-force" ? pushes(device) : kind == "any-pose" ? senses_a_pose(device) : true;
  };
  const DeviceInfo* best = nullptr;
  std::string missing;
  for (const DeviceInfo& device : there) {
    if (!fits(device)) continue;
    std::string wrong = device.missing;
    if (wrong.empty() && device.driver == kNetworkDriver)
      wrong = "any program may answer there, so it is taken by its name only: device:" + full_id(device);
    if (wrong.empty()) wrong = beyond_belief(device.can);
    if (!wrong.empty()) {
      if (missing.empty() || device.missing.empty()) missing = fmt::format("{}: {}", device.name, wrong);
    } else if (!best || (pushes(device) && device.can.max_force > best->can.max_force)) {
      best = &device;
    }
  }
  if (best) return best;
  const char* const what = kind == "any-force"  ? "no device that pushes"
                           : kind == "any-pose" ? "no device that senses position and rotation"
                                                : "no device";
  return Error{kind, fmt::format("{} is there{}", what, missing.empty() ? "" : " (" + missing + ")")};
}

// Of a driver by name, including devices that cannot be listed.
Result<DeviceChoice> by_name(const DeviceSpec& request, std::span<const DeviceInfo> there) {
  const std::vector<std::string> names = driver_names();
  if (std::find(names.begin(), names.end(), request.driver) == names.end())
    return Error{request.driver, "unknown driver", fmt::format("drivers are: {}", fmt::join(names, ", ")),
                 "device.driver"};
  const DeviceInfo* missing = nullptr;
  for (const DeviceInfo& device : there) {
    if (device.driver != request.driver || (!request.id.empty() && device.id != request.id)) continue;
    if (device.missing.empty()) return DeviceChoice{wrapped(full_id(device), request), device.name, {}};
    if (!missing) missing = &device;
  }
  if (missing) return Error{request.device(), fmt::format("{}: {}", missing->name, missing->missing)};
  return DeviceChoice{request.words(), request.device(), {}};  // open() reports it if it is missing
}

}  // namespace

std::string full_id(const DeviceInfo& device) {
  return device.id.empty() ? device.driver : device.driver + ":" + device.id;
}

Result<DeviceChoice> choose_device(const std::string& request, std::span<const DeviceInfo> there) {
  std::vector<std::string> notes;
  for (const DeviceSpec& one : parse_device_specs(request)) {
    Result<DeviceChoice> chosen = Error{"", ""};
    if (one.driver.empty()) {
      chosen = Error{request, "names no device", "write a driver, DRIVER:ID, any-force, any-pose, any or mouse"};
    } else if (one.device() == "mouse") {
      chosen = DeviceChoice{"", "mouse", {}};
    } else if (!one.has_id && (one.driver == "any" || one.driver == "any-force" || one.driver == "any-pose")) {
      if (const auto device = of_kind(one.driver, there); device)
        chosen = DeviceChoice{wrapped(full_id(**device), one), (*device)->name, {}};
      else
        chosen = device.error();
    } else {
      chosen = by_name(one, there);
    }
    if (chosen) {
      chosen->notes = std::move(notes);
      return chosen;
    }
    const Error& why = chosen.error();
    notes.push_back(why.where.empty() ? why.sentence() : fmt::format("`{}`: {}", why.where, why.sentence()));
  }
  return Error{"device:" + request, fmt::format("{}", fmt::join(notes, "; ")), "`pliant devices` lists what there is"};
}

}  // namespace pliant
