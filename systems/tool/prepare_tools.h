// Between load and the first tick: one ToolTouchState per tool, every buffer sized.
#pragma once

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// Call after spawn and before prepare_soft, whose first act per step is to read ToolInput. Allocates.
Status prepare_tools(World& world);

}  // namespace pliant
