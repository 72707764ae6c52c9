#include <fmt/format.h>

#include <algorithm>

#include "content/keys/extension_table.h"
#include "content/keys/extensions.h"
#include "content/keys/sliders.h"

namespace pliant {

Status check_references(const Level& level) {
  std::vector<std::string> devices, probes, bodies, hands;
  for (const LevelNode& node : level.nodes) {
    if (node.soft_body || node.rigid_body) bodies.push_back(node.name);
    if (node.device) devices.push_back(node.name);
    if (node.probe) probes.push_back(node.name);
    if (node.probe || node.handle) hands.push_back(node.name);
  }
  const auto check = [&](const LevelNode& node, const char* extension, const std::string& device) -> Status {
    if (device.empty() || std::find(devices.begin(), devices.end(), device) != devices.end()) return Done{};
    return Error{node.name + "." + extension + ".device",
                 "names '" + device.substr(0, 100) + "', which is no node with a PLIANT_haptic_device",
                 suggestion(device, devices), "level.unknown_device"};
  };
  for (const LevelNode& node : level.nodes) {
    if (node.effect)
      for (const std::string& name : node.effect->probes)
        if (std::find(probes.begin(), probes.end(), name) == probes.end())
          return Error{node.name + ".effect.probes",
                       "names '" + name.substr(0, 100) + "', which is no node with a PLIANT_probe",
                       suggestion(name, probes), "name.unknown"};
    if (node.joint)
      for (const auto& [key, name] : {std::pair("a", &node.joint->a), std::pair("b", &node.joint->b)})
        if (!name->empty() && std::find(bodies.begin(), bodies.end(), *name) == bodies.end())
          return Error{fmt::format("{}.joint.{}", node.name, key),
                       "names '" + name->substr(0, 100) + "', which is no soft or rigid body",
                       suggestion(*name, bodies), "name.unknown"};
    if (node.joint && !node.joint->grip.empty() &&
        std::find(hands.begin(), hands.end(), node.joint->grip) == hands.end())
      return Error{node.name + ".joint.grip",
                   "names '" + node.joint->grip.substr(0, 100) + "', which is no tool or probe",
                   suggestion(node.joint->grip, hands), "name.unknown"};
    if (node.probe)
      if (const Status status = check(node, "probe", node.probe_device); !status) return status;
    if (node.handle)
      if (const Status status = check(node, "handle", node.handle->device); !status) return status;
  }
  const auto sliders = sliders_of(level);
  return sliders ? Status(Done{}) : sliders.error();
}

}  // namespace pliant
