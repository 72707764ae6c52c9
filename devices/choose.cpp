#include "devices/choose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "devices/believable.h"
#include "devices/spec.h"

namespace pliant {
namespace {

constexpr const char* kNetworkDriver = "network";

bool pushes(const DeviceInfo& device) {
  return device.can.renders_force && !device.can.resists_only;
}
bool senses_a_pose(const DeviceInfo& device) {
  return device.can.senses_position && device.can.senses_rotation;
}

struct Alternative {
  std::string what;      // "falcon:0", "any-force", "mouse"
  std::string wrappers;  // "|delay=5ms" or empty
};

std::vector<Alternative> alternatives_of(std::string_view wish) {
  std::vector<Alternative> all;
  while (true) {
    const std::size_t end = wish.find(';');
    const std::string_view one = trimmed(wish.substr(0, end));
    const std::size_t bar = one.find('|');
    all.push_back({std::string(trimmed(one.substr(0, bar))),
                   bar == std::string_view::npos ? std::string() : std::string(one.substr(bar))});
    if (end == std::string_view::npos) return all;
    wish.remove_prefix(end + 1);
  }
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
Result<DeviceChoice> by_name(const Alternative& wish, std::span<const DeviceInfo> there) {
  const std::size_t colon = wish.what.find(':');
  const std::string driver = wish.what.substr(0, colon);
  const std::string id = colon == std::string::npos ? "" : wish.what.substr(colon + 1);
  const std::vector<std::string> names = driver_names();
  if (std::find(names.begin(), names.end(), driver) == names.end())
    return Error{driver, fmt::format("no driver has that name; drivers are: {}", fmt::join(names, ", "))};
  const DeviceInfo* missing = nullptr;
  for (const DeviceInfo& device : there) {
    if (device.driver != driver || (!id.empty() && device.id != id)) continue;
    if (device.missing.empty()) return DeviceChoice{full_id(device) + wish.wrappers, device.name, {}};
    if (!missing) missing = &device;
  }
  if (missing) return Error{wish.what, fmt::format("{}: {}", missing->name, missing->missing)};
  return DeviceChoice{wish.what + wish.wrappers, wish.what, {}};  // open() reports it if it is missing
}

}  // namespace

std::string full_id(const DeviceInfo& device) {
  return device.id.empty() ? device.driver : device.driver + ":" + device.id;
}

Result<DeviceChoice> choose_device(const std::string& wish, std::span<const DeviceInfo> there) {
  std::vector<std::string> notes;
  for (const Alternative& one : alternatives_of(wish)) {
    Result<DeviceChoice> chosen = Error{"", ""};
    if (one.what.empty()) {
      chosen = Error{wish, "names no device; write a driver, DRIVER:ID, any-force, any-pose, any or mouse"};
    } else if (one.what == "mouse") {
      chosen = DeviceChoice{"", "mouse", {}};
    } else if (one.what == "any" || one.what == "any-force" || one.what == "any-pose") {
      if (const auto device = of_kind(one.what, there); device)
        chosen = DeviceChoice{full_id(**device) + one.wrappers, (*device)->name, {}};
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
    notes.push_back(why.where.empty() ? why.what : fmt::format("`{}`: {}", why.where, why.what));
  }
  return Error{"device:" + wish, fmt::format("{}; `pliant devices` lists what there is", fmt::join(notes, "; "))};
}

}  // namespace pliant
