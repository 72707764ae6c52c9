// What there is to know about a tool after a tick, in the words of a probe (systems/touch/probe_reading.h).
#pragma once

#include "systems/touch/probe_reading.h"

namespace pliant {

// position: of the device. depth: how far the hand has led the device past the handle [m], in contact. normal: the
// mean direction in which contacts push the tool, by the newest model.
ProbeReading tool_reading(const World& world, Entity tool);

// Of a probe among soft and rigid bodies, if anything there presses it harder than what `out` already tells of:
// contact, normal and depth.
void add_body_reading(const World& world, Entity probe, ProbeReading& out);

}  // namespace pliant
