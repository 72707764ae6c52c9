// One panel of a plot: two axes with numbers, and the lines and dots in it.
#pragma once

#include <string>
#include <vector>

#include "plot/pen.h"

namespace pliant {

// Values of one axis. `log`: by powers of ten, low and high above 0.
struct PanelRange {
  double low = 0.0, high = 1.0;
  bool log = false;
};
// Around the values: up to the next ticks, zero among them where `with_zero`. By powers of ten: over what is above 0.
PanelRange range_of(double least, double most, bool with_zero);
PanelRange log_range_of(double least, double most);

struct PlotPanel {
  double x, y, w, h;  // [pixel] of the plotting area
  PanelRange across, up;
  double px(double value) const;
  double py(double value) const;
};

void draw_axes(Pen& pen, const PlotPanel& panel, const std::string& across, const std::string& up);
// What is not finite breaks the line; what lies outside is cut off.
void draw_line(Pen& pen, const PlotPanel& panel, const std::vector<double>& x, const std::vector<double>& y,
               Color color, double width);
void draw_dots(Pen& pen, const PlotPanel& panel, const std::vector<double>& x, const std::vector<double>& y,
               Color color, double radius, bool filled);

// One after the other from (x, y) on; `dot`: of dots instead of lines. Where the next would pass `right`, a line below.
struct PanelKey {
  Color color;
  std::string words;
  bool dot = false;
};
void draw_keys(Pen& pen, double x, double y, double right, const std::vector<PanelKey>& keys);

// Okabe and Ito's, in an order in which neighbours differ most; the first again after the last.
Color series_color(std::size_t number);

}  // namespace pliant
