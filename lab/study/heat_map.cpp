#include "lab/study/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plot/axis.h"
#include "plot/cairo_pen.h"
#include "plot/heat.h"

namespace pliant {
namespace {

constexpr double kMapWidth = 1240, kMapHeight = 980;                               // [pixel]
constexpr double kMapText = 17, kMapTick = 15;                                     // [pixel]
constexpr double kMapLeft = 150, kMapRight = 20, kMapTop = 190, kMapBottom = 130;  // [pixel] margins
constexpr double kGap = 10;                                                        // [pixel] between maps
constexpr Color kFailedColor{0.80, 0.24, 0.10};

// From dark to light as the error grows.
Color tone(double value, const HeatMaps& all) {
  if (!std::isfinite(value)) return kFailedColor;
  const double low = std::log10(all.low), high = std::log10(all.high);
  return heat((std::log10(std::max(value, 1e-300)) - low) / (high - low));
}

// Tick positions among the cells: powers of a thousand, or all values if there are few.
std::vector<std::size_t> ticks(const std::vector<double>& values) {
  std::vector<std::size_t> at;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double e = std::log10(std::max(values[i], 1e-300));
    if (values[i] == 0.0 || std::abs(e - std::round(e)) < 1e-6) at.push_back(i);
  }
  return at;
}

void draw_key(Pen& pen, const HeatMaps& all) {
  const double y = kMapHeight - 34, x0 = 70, w = 300;
  draw_color_bar(pen, {x0, y, w, 14}, false, heat);
  pen.color(kInk);
  for (const double v : {all.low, std::sqrt(all.low * all.high), all.high})
    pen.text(x0 + w * std::log(v / all.low) / std::log(all.high / all.low), y - 5, kMapTick, 0.5, decade_number(v));
  pen.text(x0 + w + 22, y + 13, kMapText, 0, all.tone);
  const double x = x0 + w + 22 + pen.width(kMapText, all.tone) + 30;
  pen.color(kFailedColor);
  pen.rectangle(x, y, 26, 14);
  pen.color(kInk);
  pen.text(x + 34, y + 13, kMapText, 0, all.failed);
}

void draw(Pen& pen, const HeatMaps& all) {
  const auto columns = static_cast<double>(all.columns),
             rows = std::ceil(static_cast<double>(all.maps.size()) / columns);
  const double w = (kMapWidth - kMapLeft - kMapRight - kGap * (columns - 1)) / columns;
  const double h = (kMapHeight - kMapTop - kMapBottom - kGap * (rows - 1)) / rows;
  const double cw = w / static_cast<double>(all.x.size()), ch = h / static_cast<double>(all.y.size());
  pen.color(kInk);
  pen.text(40, 44, 26, 0, all.title, true);
  double foot = 72;
  for (const std::string& line : pen.lines(kMapText, all.line, kMapWidth - 80)) {
    pen.text(40, foot, kMapText, 0, line);
    foot += 23;
  }
  for (std::size_t m = 0; m < all.maps.size(); ++m) {
    const std::size_t column = m % all.columns, row = m / all.columns;
    const double x0 = kMapLeft + static_cast<double>(column) * (w + kGap),
                 y0 = kMapTop + static_cast<double>(row) * (h + kGap);
    draw_cells(pen, {x0, y0, w, h}, all.x.size(), all.y.size(), [&](std::size_t i, std::size_t j) {
      return std::optional(tone(all.maps[m].values[j * all.x.size() + i], all));
    });
    pen.color(kInk);
    if (row == 0) {
      const std::vector<std::string> head = pen.lines(kMapText, all.maps[m].column, w);
      for (std::size_t i = 0; i < head.size(); ++i)
        pen.text(x0 + w / 2, y0 - 8 - 20 * static_cast<double>(head.size() - 1 - i), kMapText, 0.5, head[i]);
    }
    if (column == 0) {
      pen.upright_text(72, y0 + h / 2, kMapText, all.maps[m].row);
      double last = kMapHeight;
      for (const std::size_t j : ticks(all.y)) {
        const double at = y0 + h - ch * (static_cast<double>(j) + 0.5) + 4;
        if (last - at < 17) continue;
        pen.text(x0 - 6, last = at, kMapTick, 1.0, all.y[j] == 0.0 ? "0" : decade_number(all.y[j]));
      }
    }
    if (row + 1 == static_cast<std::size_t>(rows))
      for (const std::size_t i : ticks(all.x)) {
        if (all.columns > 4 && static_cast<int>(std::lround(std::log10(all.x[i]))) % 2 != 0) continue;
        // End labels are aligned inside the map, so that those of neighbouring maps do not overlap.
        const double align = i == 0 ? 0.0 : i + 1 == all.x.size() ? 1.0 : 0.5;
        pen.text(x0 + cw * (static_cast<double>(i) + align), y0 + h + 19, kMapTick, align, decade_number(all.x[i]));
      }
  }
  pen.color(kInk);
  pen.text(kMapLeft + (kMapWidth - kMapLeft - kMapRight) / 2, kMapHeight - kMapBottom + 46, kMapText, 0.5, all.across);
  pen.upright_text(32, kMapTop + (kMapHeight - kMapTop - kMapBottom) / 2, kMapText, all.up);
  draw_key(pen, all);
}

}  // namespace

Status plot_heat_maps(OutputFolder& out, const std::string& stem, const HeatMaps& maps) {
  return draw_png_and_svg(out.stage(stem + ".png"), out.stage(stem + ".svg"), kMapWidth, kMapHeight,
                          [&](Pen& pen) { draw(pen, maps); });
}

}  // namespace pliant
