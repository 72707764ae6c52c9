// What the drivers of a session could render, in a recording's settings: NODE.driver.KEY=VALUE, beside those that
// change the level. A replay feels the same limits, so that its forces are the same.
#pragma once

#include <string>
#include <vector>

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// Whatever differs from a device without a driver.
std::vector<std::string> driver_settings(const std::string& name, const HapticDevice& device);
bool is_driver_setting(const std::string& setting);
// Into the devices of the probes and tools of these names; settings of other kinds are passed over. The error names the
// first that says nothing.
Status apply_driver_settings(World& world, const std::vector<std::string>& settings);

}  // namespace pliant
