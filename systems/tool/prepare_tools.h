// Between load and the first tick: one ToolTouchState per tool, every buffer sized.
#pragma once

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// Makes World::tools anew from every Handle6. Call after spawn and before prepare_soft. Allocates. A tool without a
// device gets one that never moves, where it stands; one whose device already moves something else is refused.
Status prepare_tools(World& world);

}  // namespace pliant
