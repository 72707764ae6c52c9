// Notes about surfaces that are stiffer than a device renders stably (systems/device/softening.h).
#pragma once

#include <optional>
#include <string>

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// From the level's keys, for a probe or tool with a connected device.
std::optional<Note> stiffness_note(const World& world, Entity effector, const std::string& name);
// After a run, including vertex factors and laws. `least`: SafetyState::least_share.
std::optional<Note> softened_note(const World& world, Entity effector, const std::string& name, double least);

}  // namespace pliant
