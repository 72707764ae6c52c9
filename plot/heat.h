// Heat maps: values as colours.
#pragma once

#include <functional>
#include <optional>

#include "plot/pen.h"

namespace pliant {

// Viridis (van der Walt & Smith 2015), by polynomials: uniform in lightness, in print and for most colour vision
// deficiencies. `share` [1]: 0 is dark, 1 is light. shaders/editor_solid.frag has the same.
Color heat(double share);

struct PlotArea {
  double x, y, w, h;  // [pixel]
};
// Cells side by side, the first row at the bottom; a cell without a colour stays empty.
void draw_cells(Pen& pen, const PlotArea& area, std::size_t columns, std::size_t rows,
                const std::function<std::optional<Color>(std::size_t column, std::size_t row)>& color);
// The colours from 0 to 1, from left to right or from bottom to top.
void draw_color_bar(Pen& pen, const PlotArea& area, bool upright, const std::function<Color(double share)>& color);

}  // namespace pliant
