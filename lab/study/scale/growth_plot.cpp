// Plot of costs over sizes, in panels: points, the fitted power law as a line, and its exponent.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/study/scale/power_law.h"
#include "plot/cairo_pen.h"
#include "plot/panel.h"

namespace pliant {
namespace {

constexpr double kGrowthWidth = 1240, kPanelW = 290, kPanelH = 330, kGrowthTop = 116, kGapY = 112;  // [pixel]
constexpr double kGrowthLeft = 92, kNames = 228;            // [pixel] beside a panel
constexpr double kSentenceText = 17, kGrowthTickText = 15;  // [pixel]

// At least a decade.
PlotAxis growth_axis(double least, double most) {
  double low = std::log10(least) - 0.12, high = std::log10(most) + 0.12;
  if (high - low < 1.0) {
    const double middle = (low + high) / 2;
    low = middle - 0.5;
    high = middle + 0.5;
  }
  return {std::pow(10.0, low), std::pow(10.0, high), true};
}

void draw_panel(Pen& pen, double left, double top, const GrowthPanel& panel) {
  const double right = left + kPanelW;
  double least = 1e300, most = 0;
  for (const GrowthCurve& curve : panel.curves)
    for (const double cost : curve.cost) least = std::fmin(least, cost), most = std::fmax(most, cost);
  const auto [smallest, largest] = std::minmax_element(panel.size.begin(), panel.size.end());
  const PlotPanel axes{left, top, kPanelW, kPanelH, growth_axis(*smallest, *largest), growth_axis(least, most)};
  draw_axes(pen, axes, panel.across, panel.up, {.number = kGrowthTickText, .title = 16, .most_up = 8});
  pen.text(left, top - 14, 17, 0, panel.title, true);
  // Curve names beside their last points, without overlap.
  std::vector<std::size_t> order(panel.curves.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return panel.curves[a].cost[panel.curves[a].last()] > panel.curves[b].cost[panel.curves[b].last()];
  });
  double lowest = top - 4;
  for (const std::size_t k : order) {
    const GrowthCurve& curve = panel.curves[k];
    const Color color = series_color(k);
    const double a = curve.law.from, b = panel.size[curve.last()];
    draw_line(pen, axes, std::array{PlotPoint{a, curve.law.at(a)}, PlotPoint{b, curve.law.at(b)}},
              {color, 1.3, false, 0.6});
    draw_dots(pen, axes, points_of(panel.size, curve.cost), color, 5, true);
    const PlotPoint end = axes.on({b, curve.cost[curve.last()]});
    const double at = std::max(end.y, lowest + 22);
    lowest = at + 19;
    pen.color(color, 0.6);
    pen.line(end.x + 7, end.y, right + 10, at, 0.8);
    pen.color(kInk);
    pen.text(right + 14, at + 4, 16, 0, curve.name, true);
    pen.text(right + 14, at + 22, kGrowthTickText, 0, "power " + words_of(curve.law));
  }
}

}  // namespace

Status plot_growth(OutputFolder& out, const std::string& stem, const std::string& title,
                   const std::vector<GrowthPanel>& panels, const std::vector<std::string>& sentences) {
  const auto rows = static_cast<double>((panels.size() + 1) / 2);
  const double bottom = kGrowthTop + rows * (kPanelH + kGapY) - kGapY + 84;
  std::vector<std::string> lines;
  for (const std::string& sentence : sentences) {
    CairoPen measure(1, 1);
    const std::vector<std::string> broken = measure.lines(kSentenceText, sentence, kGrowthWidth - 60);
    lines.insert(lines.end(), broken.begin(), broken.end());
  }
  const double height = bottom + 22 * static_cast<double>(lines.size());
  return draw_png_and_svg(out.stage(stem + ".png"), out.stage(stem + ".svg"), kGrowthWidth, height, [&](Pen& pen) {
    pen.color(kInk);
    pen.text(30, 44, 26, 0, stem, true);
    pen.text(30, 72, kSentenceText, 0, title);
    for (std::size_t i = 0; i < panels.size(); ++i)
      draw_panel(pen, kGrowthLeft + static_cast<double>(i % 2) * (kPanelW + kNames + 100),
                 kGrowthTop + static_cast<double>(i / 2) * (kPanelH + kGapY), panels[i]);
    double foot = bottom;
    pen.color(kInk);
    for (const std::string& line : lines) {
      pen.text(30, foot, kSentenceText, 0, line);
      foot += 22;
    }
  });
}

}  // namespace pliant
