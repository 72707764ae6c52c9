// Rendering limits of a session's drivers, stored in a recording's settings as NODE.driver.KEY=VALUE beside the level's
// settings. A replay applies the same limits, so that its forces are the same.
#pragma once

#include <string>
#include <vector>

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// Every property that differs from a device without a driver.
std::vector<std::string> driver_settings(const std::string& name, const HapticDevice& device);
bool is_driver_setting(const std::string& setting);
// Applies settings to the devices of the named probes and tools; other settings are ignored. The error names the first
// invalid one.
Status apply_driver_settings(World& world, const std::vector<std::string>& settings);

}  // namespace pliant
