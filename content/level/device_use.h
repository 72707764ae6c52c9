// Which device moves which probe or tool. A device may move only one: with two, each would compute a full force, and
// only the last would be rendered.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

struct DeviceFault {
  std::size_t node;  // a probe or tool
  Note what;         // text that follows "node X"
};

// Probes and tools whose device already moves another one. In the order of the nodes; only those of the scene.
std::vector<DeviceFault> find_shared_devices(const Level& level);

// Probes in the scene with no device, or with driver `null`: they do not move.
std::vector<DeviceFault> find_unmoved_probes(const Level& level);

}  // namespace pliant
