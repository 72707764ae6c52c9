// Reads the state of one probe or tool after a tick (systems/touch/feed/probe_reading.h).
#pragma once

#include "systems/touch/feed/probe_reading.h"

namespace pliant {

// Of a probe; for a tool see systems/tool/tool_reading.h.
ProbeReading reading(const World& world, Entity hand);

}  // namespace pliant
