// What a device may say of itself. Its limits are never raised, and they are only as good as who says them: one of
// 1e9 N would bound nothing.
#pragma once

#include <string>

#include "pliant/driver.h"

namespace pliant {

// "" or what cannot be, and the cure.
std::string beyond_belief(const DeviceCapabilities& can);

}  // namespace pliant
