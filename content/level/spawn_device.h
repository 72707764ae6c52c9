// The devices of a level's nodes, and the effectors that they move: probes and handles.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <unordered_map>

#include "content/level/spawn_state.h"

namespace pliant {

class DeviceSpawner {
 public:
  explicit DeviceSpawner(SpawnState& state) : state_(state) {}

  // Adds the node's HapticDevice, if it has one.
  Status add_device(std::size_t n);
  // After all devices are added: each probe gets its device, and the devices that handles name exist.
  Status link_effectors();
  // Gives probes a surface mesh if there is a soft or rigid body.
  Status give_shells();

 private:
  const std::size_t* find_device(const std::string& name) const;
  Status link_probe(std::size_t n);
  Status check_handle(std::size_t n) const;

  SpawnState& state_;
  std::map<const Path*, Handle<Path>> paths_;             // of scripts that move devices
  std::unordered_map<std::string, std::size_t> by_name_;  // first node in the scene with this name
};

}  // namespace pliant
