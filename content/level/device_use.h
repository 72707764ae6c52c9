// Which device moves which probe or tool. One device moves one of them: two would each be told that the whole of its
// force is theirs, and only the last one's would leave.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"

namespace pliant {

struct DeviceFault {
  std::size_t node;  // a probe or tool whose device moves another one already
  std::string what;  // as what follows "node X"
};

// In the order of the nodes; only those of the scene.
std::vector<DeviceFault> find_shared_devices(const Level& level);

}  // namespace pliant
