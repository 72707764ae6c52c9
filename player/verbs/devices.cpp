// pliant devices: lists the sources that can move a probe: the built-in ones, and devices found by the drivers.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "devices/choose.h"
#include "lab/console/print.h"
#include "player/verbs/verbs.h"
#include "pliant/driver.h"
#include "pliant/drivers.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

struct BuiltIn {
  const char* name;
  const char* what;
  const char* use;
};
constexpr BuiltIn kBuiltIn[] = {
    {"script", "follows a CSV of times and poses",
     "--probe NAME=script:FILE.csv (header time_s,x,y,z; metres, world frame)"},
    {"orbit", "approaches, presses, slides and leaves, by itself", "--probe NAME=orbit"},
    {"mouse", "moves in the plane of the picture", "in a window: `pliant run LEVEL --probe finger=mouse`"},
    {"null", "stays where the level put it", "\"driver\": \"null\" in the level's PLIANT_haptic_device"},
};

// "senses position and rotation; pushes up to 8 N (2.5 N for long)"
std::string describe(const DeviceCapabilities& can) {
  std::vector<std::string> senses, renders;
  if (can.senses_position) senses.push_back("position");
  if (can.senses_rotation) senses.push_back("rotation");
  if (can.senses_grip) senses.push_back("grip");
  const auto up_to = [](double most, double lasting, const char* unit) {
    if (!(most > 0.0)) return std::string();
    return fmt::format(" up to {:g} {}{}", most, unit,
                       lasting > 0.0 ? fmt::format(" ({:g} {} for long)", lasting, unit) : "");
  };
  if (can.renders_force)
    renders.push_back((can.resists_only ? "brakes" : "pushes") + up_to(can.max_force, can.continuous_force, "N"));
  if (can.renders_torque) renders.push_back("turns" + up_to(can.max_torque, 0.0, "N m"));
  if (can.renders_grip) renders.push_back("resists the grip");
  if (can.renders_vibration) renders.push_back("vibrates");
  return fmt::format("{}; {}{}",
                     senses.empty() ? "senses buttons" : "senses " + fmt::format("{}", fmt::join(senses, ", ")),
                     renders.empty() ? "no force" : fmt::format("{}", fmt::join(renders, ", ")),
                     can.rate > 0.0 ? fmt::format("; {:g} Hz", can.rate) : "");
}

std::string how_to_use(const DeviceInfo& device) {
  if (!device.missing.empty()) return device.missing;
  return fmt::format("--probe NAME=device:{}; try it: pliant devices --test {}{}", full_id(device), full_id(device),
                     device.also.empty() ? std::string() : "; the general driver takes it as " + device.also);
}

void print_as_json(const std::vector<DeviceInfo>& found) {
  nlohmann::ordered_json out;
  out["built_in"] = nlohmann::ordered_json::array();
  for (const BuiltIn& source : kBuiltIn)
    out["built_in"].push_back({{"name", source.name}, {"what", source.what}, {"use", source.use}});
  out["found"] = nlohmann::ordered_json::array();
  for (const DeviceInfo& device : found)
    out["found"].push_back({{"id", printable(full_id(device))},
                            {"driver", device.driver},
                            {"what", describe(device.can)},
                            {"product", printable(device.name)},
                            {"opens", device.missing.empty()},
                            {"use", printable(how_to_use(device))}});
  print_json(out);
}

}  // namespace

int devices(bool json) {
  register_all_drivers();
  const std::vector<DeviceInfo> found = list_devices();
  if (json) {
    print_as_json(found);
    return 0;
  }
  print("Built in:\n");
  for (const BuiltIn& source : kBuiltIn) print("  {:<8} {}\n           {}\n", source.name, source.what, source.use);
  const auto list = [&](const char* title, bool usable) {
    bool any = false;
    for (const DeviceInfo& device : found) {
      if (device.missing.empty() != usable) continue;
      if (!any) print("\n{}:\n", title);
      any = true;
      print("  {}  {}\n           {}\n           {}\n", printable(full_id(device)), printable(device.name),
            describe(device.can), printable(how_to_use(device)));
    }
    return any;
  };
  if (!list("Found on this machine", true))
    print("\nFound on this machine:\n  no device (plugged in, switched on, passed through to this machine?)\n");
  list("Not usable yet", false);
  return 0;
}

}  // namespace pliant
