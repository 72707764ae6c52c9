// One panel of a plot: a figure of a sweep along an axis, or over two.
#pragma once

#include <string>
#include <vector>

#include "lab/sweep/plot_scale.h"
#include "plot/heat.h"

namespace pliant {

struct Figure {
  std::string name;
  std::vector<double> of_row;  // NaN for a run without it
};

inline constexpr std::size_t kMostDots = 2000;  // per panel, which they cover

// Steps: the mean over the other axes at each step, and its range. Samples: a dot per run.
void draw_curve(Pen& pen, const PlotArea& area, const Figure& figure, const AxisValues& axis, bool sampled);
// Axes of steps: cells with the mean over the other axes. Samples: a dot per run.
void draw_map(Pen& pen, PlotArea area, const Figure& figure, const AxisValues& across, const AxisValues& up,
              bool sampled);
// True if its map would have one colour.
bool is_flat(const Figure& figure, const AxisValues& across, const AxisValues& up, bool sampled);

}  // namespace pliant
