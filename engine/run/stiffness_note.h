// What is said of a surface that is stiffer than a device renders stably (systems/device/softening.h).
#pragma once

#include <string>

#include "components/world.h"

namespace pliant {

// By the level's keys, for a probe or tool whose device is connected: one sentence, or none.
std::string stiffness_note(const World& world, Entity effector, const std::string& name);
// After a run, vertices and laws counted. `least`: SafetyState::least_share.
std::string softened_note(const World& world, Entity effector, const std::string& name, double least);

}  // namespace pliant
