// State of a tool after a tick, in the format of a probe (systems/touch/feed/probe_reading.h).
#pragma once

#include "systems/touch/feed/probe_reading.h"

namespace pliant {

// position: of the device. depth: distance from the handle to the device's target pose [m], in contact. normal: the
// mean direction in which contacts push the tool, by the newest model.
ProbeReading tool_reading(const World& world, Entity tool);

// For a probe among soft and rigid bodies: sets contact, normal and depth if a body presses it harder than the contact
// already in `out`.
void add_body_reading(const World& world, Entity probe, ProbeReading& out);

}  // namespace pliant
