// Keys of a level that a Session can change between ticks, and the reasons against the others.
#pragma once

#include <string>
#include <vector>

#include "components/deformable.h"
#include "components/haptic_device.h"
#include "content/keys/extension_table.h"

namespace pliant {

// Empty if the key is live; otherwise the reason and the remedy: "the mesh is built with it; change the scene and open
// it again".
std::string why_not_live(const Extension& extension, const Key& key);

// Keys that set() changes and that are a single number: of surfaces, and of the devices of probes and tools.
struct LiveKey {
  const char* key;
  double DeformableParameters::*surface = nullptr;
  double DeviceParameters::*device = nullptr;
};
const std::vector<LiveKey>& live_keys();

}  // namespace pliant
