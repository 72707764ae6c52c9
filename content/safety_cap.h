// What a file may ask of a haptic device. A level's limits on force are its maker's word; whoever holds the device has
// the last one.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"
#include "pliant/content.h"

namespace pliant {

// Lowers max_force, max_slew and max_torque of every device and tool of the level to the cap; one sentence says of how
// many, none where nothing was above it. Saving the level keeps what its file said.
std::vector<std::string> cap_safety(Level& level, const SafetyCap& cap);

}  // namespace pliant
