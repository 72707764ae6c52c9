// Plot of costs over sizes, in panels: points, the fitted power law as a line, and its exponent.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/study/scale/power_law.h"
#include "plot/pen.h"

namespace pliant {
namespace {

constexpr double kGrowthWidth = 1240, kPanelW = 290, kPanelH = 330, kGrowthTop = 116, kGapY = 112;  // [pixel]
constexpr double kGrowthLeft = 92, kNames = 228;            // [pixel] beside a panel
constexpr double kSentenceText = 17, kGrowthTickText = 15;  // [pixel]
constexpr std::array kGrowthColors{kBlue, kVermilion, kGreen, kPurple, kOrange, kInk};

struct AxisRange {
  double low, high, begin, end;
  double at(double value) const { return begin + (end - begin) * (std::log10(value) - low) / (high - low); }
};

AxisRange range_of(double least, double most, double begin, double end) {
  double low = std::log10(least) - 0.12, high = std::log10(most) + 0.12;
  if (high - low < 1.0) {
    const double middle = (low + high) / 2;
    low = middle - 0.5;
    high = middle + 0.5;
  }
  return {low, high, begin, end};
}

void draw_axis(Pen& pen, const AxisRange& range, bool across, double from, double to) {
  const bool few = range.high - range.low > 2.2;
  double free_from = -1e9;  // [pixel] left end of the free space for the next number on the x axis
  for (int decade = static_cast<int>(std::floor(range.low)); decade <= range.high; ++decade)
    for (const int factor : {1, 2, 5}) {
      const double value = factor * std::pow(10.0, decade), e = std::log10(value);
      if (e < range.low || e > range.high || (few && factor != 1)) continue;
      const double p = range.at(value);
      pen.color(kFaint);
      across ? pen.line(p, from, p, to, 1) : pen.line(from, p, to, p, 1);
      pen.color(kInk);
      const std::string number = decade_number(value);
      if (!across) {
        pen.text(from - 7, p + 5, kGrowthTickText, 1.0, number);
      } else if (const double half = 0.5 * pen.width(kGrowthTickText, number); p - half > free_from) {
        pen.text(p, to + 20, kGrowthTickText, 0.5, number);
        free_from = p + half + 6;
      }
    }
}

void draw_panel(Pen& pen, double left, double top, const GrowthPanel& panel) {
  const double right = left + kPanelW, bottom = top + kPanelH;
  double least = 1e300, most = 0;
  for (const GrowthCurve& curve : panel.curves)
    for (const double cost : curve.cost) least = std::fmin(least, cost), most = std::fmax(most, cost);
  const AxisRange x = range_of(*std::min_element(panel.size.begin(), panel.size.end()),
                               *std::max_element(panel.size.begin(), panel.size.end()), left, right);
  const AxisRange y = range_of(least, most, bottom, top);
  draw_axis(pen, x, true, top, bottom);
  draw_axis(pen, y, false, left, right);
  pen.color(kInk);
  pen.line(left, top, left, bottom, 1.5);
  pen.line(left, bottom, right, bottom, 1.5);
  pen.text(left, top - 14, 17, 0, panel.title, true);
  pen.text((left + right) / 2, bottom + 44, 16, 0.5, panel.across);
  pen.upright_text(left - 68, (top + bottom) / 2, 16, panel.up);
  // Curve names beside their last points, without overlap.
  std::vector<std::size_t> order(panel.curves.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return panel.curves[a].cost[panel.curves[a].last()] > panel.curves[b].cost[panel.curves[b].last()];
  });
  double lowest = top - 4;
  for (const std::size_t k : order) {
    const GrowthCurve& curve = panel.curves[k];
    const Color color = kGrowthColors[k % kGrowthColors.size()];
    pen.color(color, 0.6);
    const double a = curve.law.from, b = panel.size[curve.last()];
    cairo_save(pen.get());
    cairo_rectangle(pen.get(), left, top, kPanelW, kPanelH);
    cairo_clip(pen.get());
    pen.line(x.at(a), y.at(curve.law.at(a)), x.at(b), y.at(curve.law.at(b)), 1.3);
    cairo_restore(pen.get());
    pen.color(color);
    for (std::size_t i = 0; i < panel.size.size(); ++i) {
      if (std::isnan(curve.cost[i])) continue;
      cairo_arc(pen.get(), x.at(panel.size[i]), y.at(curve.cost[i]), 5, 0, 2 * M_PI);
      cairo_fill(pen.get());
    }
    const double end = y.at(curve.cost[curve.last()]), at = std::max(end, lowest + 22);
    lowest = at + 19;
    pen.color(color, 0.6);
    pen.line(x.at(panel.size[curve.last()]) + 7, end, right + 10, at, 0.8);
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
    Pen measure(1, 1);
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
