#include "engine/run/driver_limits.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "systems/device/hands.h"

namespace pliant {
namespace {

constexpr std::string_view kMark = ".driver.";

// A numeric device property that its driver sets.
struct DriverKey {
  const char* name;
  double (*get)(const HapticDevice& device);
  void (*put)(HapticDevice& device, double value);
};

constexpr DriverKey kKeys[] = {
    {"renders_force", [](const HapticDevice& d) { return d.can.renders_force ? 1.0 : 0.0; },
     [](HapticDevice& d, double value) { d.can.renders_force = value != 0.0; }},
    {"renders_torque", [](const HapticDevice& d) { return d.can.renders_torque ? 1.0 : 0.0; },
     [](HapticDevice& d, double value) { d.can.renders_torque = value != 0.0; }},
    {"max_force", [](const HapticDevice& d) { return d.can.max_force; },
     [](HapticDevice& d, double value) { d.can.max_force = value; }},
    {"max_torque", [](const HapticDevice& d) { return d.can.max_torque; },
     [](HapticDevice& d, double value) { d.can.max_torque = value; }},
    {"max_stiffness", [](const HapticDevice& d) { return d.can.max_stiffness; },
     [](HapticDevice& d, double value) { d.can.max_stiffness = value; }},
    {"scale", [](const HapticDevice& d) { return d.workspace; },
     [](HapticDevice& d, double value) { d.workspace = value > 0.0 ? value : 1.0; }},
};

// The parts of a setting. The name may contain dots and equals signs, the rest may not.
struct Parts {
  std::string name, key;
  double value = 0.0;
};
std::optional<Parts> parse(const std::string& setting) {
  const std::size_t equals = setting.rfind('='), mark = setting.rfind(kMark, equals);
  if (equals == std::string::npos || mark == std::string::npos) return std::nullopt;
  const std::string text = setting.substr(equals + 1);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value) || value < 0.0) return std::nullopt;
  const std::size_t key = mark + kMark.size();
  return Parts{setting.substr(0, mark), setting.substr(key, equals - key), value};
}

HapticDevice* find_device_of(World& world, const std::string& name) {
  for (const Entity hand : hands(world))
    if (const Name* its_name = world.registry.find<Name>(hand); its_name && its_name->value == name)
      return find_device(world, hand) ? &world.registry.get<HapticDevice>(device_of(world, hand)) : nullptr;
  return nullptr;
}

}  // namespace

std::vector<std::string> driver_settings(const std::string& name, const HapticDevice& device) {
  static const HapticDevice none;
  std::vector<std::string> settings;
  for (const DriverKey& key : kKeys)
    if (key.get(device) != key.get(none))
      settings.push_back(fmt::format("{}{}{}={}", name, kMark, key.name, key.get(device)));
  return settings;
}

bool is_driver_setting(const std::string& setting) {
  const std::size_t equals = setting.rfind('='), mark = setting.rfind(kMark, equals);
  return equals != std::string::npos && mark != std::string::npos && setting.find('.', mark + kMark.size()) > equals;
}

Status apply_driver_settings(World& world, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    if (!is_driver_setting(setting)) continue;
    const std::optional<Parts> parts = parse(setting);
    HapticDevice* const device = parts ? find_device_of(world, parts->name) : nullptr;
    bool known = false;
    for (const DriverKey& key : kKeys) {
      if (!device || parts->key != key.name) continue;
      key.put(*device, parts->value);
      known = true;
    }
    if (!known) return Error{"`" + setting + "`", "is no limit of a driver of this scene", "record it again"};
  }
  return Done{};
}

}  // namespace pliant
