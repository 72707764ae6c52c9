// One panel of a plot: two numbered axes, with lines and dots.
#pragma once

#include <string>
#include <vector>

#include "plot/pen.h"

namespace pliant {

// Range of one axis. `log`: logarithmic, low and high above 0.
struct PanelRange {
  double low = 0.0, high = 1.0;
  bool log = false;
};
// Range around the values, up to the next ticks, including zero if `with_zero`. Logarithmic: over the values above 0.
PanelRange range_of(double least, double most, bool with_zero);
PanelRange log_range_of(double least, double most);

struct PlotPanel {
  double x, y, w, h;  // [pixel] of the plotting area
  PanelRange across, up;
  double px(double value) const;
  double py(double value) const;
};

void draw_axes(Pen& pen, const PlotPanel& panel, const std::string& across, const std::string& up);
// A non-finite value breaks the line; parts outside are clipped.
void draw_line(Pen& pen, const PlotPanel& panel, const std::vector<double>& x, const std::vector<double>& y,
               Color color, double width);
void draw_dots(Pen& pen, const PlotPanel& panel, const std::vector<double>& x, const std::vector<double>& y,
               Color color, double radius, bool filled);

// Legend entries from (x, y) on; `dot`: dots instead of lines. An entry that would pass `right` starts a new line.
struct PanelKey {
  Color color;
  std::string words;
  bool dot = false;
};
void draw_keys(Pen& pen, double x, double y, double right, const std::vector<PanelKey>& keys);

// Okabe and Ito's colours, ordered for contrast between neighbours; cyclic.
Color series_color(std::size_t number);

}  // namespace pliant
