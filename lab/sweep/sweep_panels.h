// One figure of a sweep in one panel of a plot: along an axis, or over two.
#pragma once

#include <string>
#include <vector>

#include "lab/sweep/plot_scale.h"
#include "plot/pen.h"

namespace pliant {

struct PlotArea {
  double x, y, w, h;  // [pixel]
};

struct Figure {
  std::string name;
  std::vector<double> of_row;  // NaN where a run has none
};

inline constexpr std::size_t kMostDots = 2000;  // of a panel, which they cover

// Mean over the other axes at each step, and the range in which they lie; of samples every run is a dot.
void draw_curve(Pen& pen, const PlotArea& area, const Figure& figure, const AxisValues& axis, bool sampled);
// Cells of two axes of steps, each the mean over the other axes; of samples a dot for each run.
void draw_map(Pen& pen, PlotArea area, const Figure& figure, const AxisValues& across, const AxisValues& up,
              bool sampled);
// A map of it would have one colour.
bool is_flat(const Figure& figure, const AxisValues& across, const AxisValues& up, bool sampled);

}  // namespace pliant
