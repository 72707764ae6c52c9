// Takes what there is to know about one probe or tool after a tick (systems/touch/probe_reading.h).
#pragma once

#include "systems/touch/probe_reading.h"

namespace pliant {

// A probe's; of a tool: systems/tool/tool_reading.h.
ProbeReading reading(const World& world, Entity hand);

}  // namespace pliant
