// Between load and the first tick: one ToolTouchState per tool, every buffer sized.
#pragma once

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// Rebuilds World::tools from every Handle6. Call after spawn and before prepare_soft. Allocates. A tool without a
// device gets a fixed one at its pose; a device that already moves something else is rejected.
Status prepare_tools(World& world);

// Real time: solving contacts again may take this share of a tick. After a few ticks over budget the linear model
// replaces it (tool_feedback.h). Without this call, as in lockstep, no tick reads wall time. Call before the clocks
// start.
inline constexpr double kTickBudgetShare = 0.3;  // [1] more: other systems of the tick become late
void limit_tool_ticks(World& world);

}  // namespace pliant
