// Plausibility check of a device's capabilities. Its limits are trusted, so a limit of 1e9 N would limit nothing.
#pragma once

#include <string>

#include "pliant/driver.h"

namespace pliant {

// Returns "" or the implausible value and the remedy.
std::string beyond_belief(const DeviceCapabilities& can);

}  // namespace pliant
