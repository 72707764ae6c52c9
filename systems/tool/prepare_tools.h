// Between load and the first tick: one ToolTouchState per tool, every buffer sized.
#pragma once

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// Makes World::tools anew from every Handle6. Call after spawn and before prepare_soft. Allocates. A tool without a
// device gets one that never moves, where it stands; one whose device already moves something else is refused.
Status prepare_tools(World& world);

// Real time: solving contacts again may take this share of a tick; after a few ticks over it the linear model takes
// over (tool_feedback.h). Without it, as in lockstep, no tick looks at the wall's clock. Before the clocks start.
inline constexpr double kTickBudgetShare = 0.3;  // [1] more: other systems of the tick come late
void limit_tool_ticks(World& world);

}  // namespace pliant
