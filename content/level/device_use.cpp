#include "content/level/device_use.h"

#include <algorithm>
#include <unordered_map>

namespace pliant {

namespace {

// The first node in the scene with a name.
std::unordered_map<std::string, std::size_t> nodes_by_name(const Level& level) {
  std::unordered_map<std::string, std::size_t> by_name;
  for (std::size_t n = 0; n < level.nodes.size(); ++n)
    if (level.nodes[n].in_scene) by_name.try_emplace(level.nodes[n].name, n);
  return by_name;
}

}  // namespace

std::vector<DeviceFault> find_shared_devices(const Level& level) {
  const std::unordered_map<std::string, std::size_t> by_name = nodes_by_name(level);
  std::unordered_map<std::size_t, std::size_t> moves;  // device -> probe or tool
  std::vector<DeviceFault> faults;
  const auto use = [&](std::size_t n, const std::string& named) {
    const auto found = named.empty() ? by_name.end() : by_name.find(named);
    if (!named.empty() && found == by_name.end()) return;  // spawn reports it
    const std::size_t device = named.empty() ? n : found->second;
    if (!level.nodes[device].device) return;
    const auto [taken, fresh] = moves.try_emplace(device, n);
    if (!fresh)
      faults.push_back(
          {n,
           {"is moved by the device `" + level.nodes[device].name + "`, which moves `" +
                level.nodes[taken->second].name + "` already",
            "give each a node with PLIANT_haptic_device of its own", "level.shared_device", level.nodes[n].name}});
  };
  for (std::size_t n = 0; n < level.nodes.size(); ++n) {
    const LevelNode& node = level.nodes[n];
    if (!node.in_scene) continue;
    if (node.probe) use(n, node.probe_device);
    if (node.handle) use(n, node.handle->device);
  }
  return faults;
}

std::vector<DeviceFault> find_unmoved_probes(const Level& level) {
  const std::unordered_map<std::string, std::size_t> by_name = nodes_by_name(level);
  std::vector<DeviceFault> found;
  const bool orbits = std::any_of(level.nodes.begin(), level.nodes.end(),
                                  [](const LevelNode& node) { return node.in_scene && node.deformable; });
  for (std::size_t n = 0; n < level.nodes.size(); ++n) {
    const LevelNode& node = level.nodes[n];
    if (!node.in_scene || !node.probe) continue;
    std::size_t mover = n;
    if (!node.probe_device.empty()) {
      const auto named = by_name.find(node.probe_device);
      if (named == by_name.end()) continue;  // spawn reports it
      mover = named->second;
    }
    const std::optional<HapticDevice>& device = level.nodes[mover].device;
    const std::string cure =
        "give it one that moves it, or run it with --probe " + node.name + (orbits ? "=orbit" : "=script:FILE.csv");
    const char* const what = !device ? "is a probe without a PLIANT_haptic_device, so nothing moves it"
                             : device->driver == DriverKind::kNull
                                 ? "is a probe whose device has the `driver` `null`, so nothing moves it"
                                 : nullptr;
    if (what) found.push_back({n, {what, cure, "level.unmoved_probe", node.name}});
  }
  return found;
}

}  // namespace pliant
