#include "plot/heat.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace pliant {
namespace {

constexpr double kSeam = 1.0;  // [pixel] a cell reaches below the next one, so that no gap is visible
constexpr std::size_t kSlices = 100;

}  // namespace

Color heat(double share) {
  constexpr double kFit[][3] = {{0.2777, 0.0054, 0.3341},     {0.1051, 1.4046, 1.3846},   {-0.3309, 0.2148, 0.0951},
                                {-4.6342, -5.7991, -19.3324}, {6.2283, 14.1799, 56.6906}, {4.7764, -13.7451, -65.3530},
                                {-5.4355, 4.6459, 26.3124}};
  share = std::clamp(share, 0.0, 1.0);
  double of[3] = {};
  for (std::size_t i = std::size(kFit); i-- > 0;)
    for (int c = 0; c < 3; ++c) of[c] = kFit[i][c] + share * of[c];
  return {std::clamp(of[0], 0.0, 1.0), std::clamp(of[1], 0.0, 1.0), std::clamp(of[2], 0.0, 1.0)};
}

void draw_cells(Pen& pen, const PlotArea& area, std::size_t columns, std::size_t rows,
                const std::function<std::optional<Color>(std::size_t, std::size_t)>& color) {
  const double w = area.w / static_cast<double>(columns), h = area.h / static_cast<double>(rows);
  for (std::size_t row = rows; row-- > 0;)
    for (std::size_t column = 0; column < columns; ++column) {
      const std::optional<Color> of = color(column, row);
      if (!of) continue;
      pen.color(*of);
      pen.rectangle(area.x + w * static_cast<double>(column), area.y + area.h - h * static_cast<double>(row + 1),
                    column + 1 < columns ? w + kSeam : w, row > 0 ? h + kSeam : h);
    }
}

void draw_color_bar(Pen& pen, const PlotArea& area, bool upright, const std::function<Color(double)>& color) {
  draw_cells(pen, area, upright ? 1 : kSlices, upright ? kSlices : 1, [&](std::size_t column, std::size_t row) {
    return std::optional(color((static_cast<double>(upright ? row : column) + 0.5) / kSlices));
  });
}

}  // namespace pliant
