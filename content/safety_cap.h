// Caps the forces that a level may request from a haptic device. The user's cap takes precedence over the level's
// limits.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"
#include "pliant/content.h"

namespace pliant {

// Lowers max_force, max_slew and max_torque of all devices and tools of the level to the cap. Returns a sentence with
// their number, empty if none was above it. Saving the level keeps the file's values.
std::vector<std::string> cap_safety(Level& level, const SafetyCap& cap);

}  // namespace pliant
