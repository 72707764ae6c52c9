// Legend of the colours of painted values: the ramp with numbers.
#pragma once

#include <imgui.h>

#include "editor/core/editor.h"

namespace pliant {

// Places on the colour bar [1] and the values there: for a factor powers of two, for a share tenths that matter; both
// ends.
struct LegendTick {
  double place, value;
};
std::vector<LegendTick> legend_ticks(bool share, double low, double high);
// Its lower left corner at `at` [pixel].
void draw_legend(const Editor& editor, Channel channel, ImVec2 at, ImDrawList& list);

}  // namespace pliant
