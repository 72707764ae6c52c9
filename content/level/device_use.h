// Which device moves which probe or tool. One device moves one of them: two would each be told that the whole of its
// force is theirs, and only the last one's would leave.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"

namespace pliant {

struct DeviceFault {
  std::size_t node;  // a probe or tool
  std::string what;  // as what follows "node X"
};

// Probes and tools whose device moves another one already. In the order of the nodes; only those of the scene.
std::vector<DeviceFault> find_shared_devices(const Level& level);

// Probes in the scene that no device moves, or one whose driver is `null`: they stand where they are.
std::vector<DeviceFault> find_unmoved_probes(const Level& level);

}  // namespace pliant
