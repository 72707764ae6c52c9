// The checks of a file reader, for a scene made in code (pliant/scene.h).
#pragma once

#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

// Checks that array sizes match, indices are in range, and every key is within its range
// (content/keys/extension_table.h). Sets derived values as a reader does. The error names mesh or node.
Status check_scene(Level& level);

// Checks a device's limits: the force on a hand is clamped by them.
Status check_device(const std::string& name, const DeviceParameters& device);

}  // namespace pliant
