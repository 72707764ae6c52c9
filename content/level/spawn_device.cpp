#include "content/level/spawn_device.h"

#include <fmt/format.h>

#include <algorithm>

#include "content/files/file_io.h"
#include "content/level/probe_shell.h"

namespace pliant {
namespace {

std::string no_such_device(const char* key, const std::string& name) {
  return fmt::format(
      "{} names `{}`, which is no node of this scene with PLIANT_haptic_device; correct the name, or add the device",
      key, name);
}

}  // namespace

Status DeviceSpawner::add_device(std::size_t n) {
  if (!state_.level.nodes[n].device) return Done{};
  HapticDevice device = *state_.level.nodes[n].device;
  if (device.driver == DriverKind::kScript) {
    if (device.file.empty())
      return state_.at(n, "its driver is `script` but `file` is missing; name a .csv file, relative to the level");
    const Result<std::filesystem::path> file = confined_path(state_.folder, device.file);
    if (!file) return state_.at(n, file.error().message());
    Result<const Path*> path = state_.scripts.read(*file, false);
    if (!path) return path.error();
    const auto [shared, is_new] = paths_.try_emplace(*path);
    if (is_new) shared->second = state_.world.paths.add(Path(**path));
    device.path = shared->second;
  }
  device.position = dvec3(state_.motions.world[n][3]);
  state_.world.registry.add<HapticDevice>(state_.entities[n], std::move(device));
  return Done{};
}

Status DeviceSpawner::link_effectors() {
  const std::vector<LevelNode>& nodes = state_.level.nodes;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (nodes[n].in_scene) by_name_.try_emplace(nodes[n].name, n);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (Status s = link_probe(n); !s) return s;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (Status s = check_handle(n); !s) return s;
  return Done{};
}

// The node with the device of this name; nullptr: none.
const std::size_t* DeviceSpawner::find_device(const std::string& name) const {
  const auto found = by_name_.find(name);
  return found != by_name_.end() && state_.level.nodes[found->second].device ? &found->second : nullptr;
}

// A probe is moved by the device it names, else by the device on its own node, else by none.
Status DeviceSpawner::link_probe(std::size_t n) {
  const LevelNode& node = state_.level.nodes[n];
  if (!node.probe || !node.in_scene) return Done{};
  Probe& probe = state_.world.registry.get<Probe>(state_.entities[n]);
  if (node.probe_device.empty()) {
    if (node.device) probe.device = state_.entities[n];
    return Done{};
  }
  const std::size_t* const found = find_device(node.probe_device);
  if (!found) return state_.at(n, no_such_device("PLIANT_probe/device", node.probe_device));
  probe.device = state_.entities[*found];
  return Done{};
}

// A handle refers to its device by name.
Status DeviceSpawner::check_handle(std::size_t n) const {
  const LevelNode& node = state_.level.nodes[n];
  if (!node.handle || !node.in_scene || node.handle->device.empty() || find_device(node.handle->device)) return Done{};
  return state_.at(n, no_such_device("PLIANT_handle/device", node.handle->device));
}

Status DeviceSpawner::give_shells() {
  const std::vector<LevelNode>& nodes = state_.level.nodes;
  const auto is_body = [](const LevelNode& node) { return node.in_scene && (node.soft_body || node.rigid_body); };
  if (std::none_of(nodes.begin(), nodes.end(), is_body)) return Done{};
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (!nodes[n].probe || !nodes[n].in_scene) continue;
    Probe& probe = state_.world.registry.get<Probe>(state_.entities[n]);
    if (probe.meets == ProbeMeets::kSurfaces) continue;
    Result<Mesh> shell = probe_shell(probe);
    if (!shell) return shell.error();
    probe.shell = state_.world.meshes.add(std::move(*shell));
  }
  return Done{};
}

}  // namespace pliant
