#include "lab/sweep/sweep_plot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "lab/sweep/sweep_panels.h"
#include "plot/cairo_pen.h"
#include "plot/ticks.h"

namespace pliant {
namespace {

// [pixel]
constexpr double kSheetWidth = 1600, kSheetTitle = 84, kSheetRow = 330, kSheetFoot = 10, kSheetLeft = 84,
                 kSheetRight = 28, kSheetBetween = 100;
constexpr double kAbovePlot = 36, kBelowPlot = 66;
constexpr int kPlotColumns = 3;
constexpr std::size_t kMostPanels = 24;  // per picture
constexpr std::size_t kMostMaps = 10;    // pairs of axes
constexpr std::size_t kMostCurves = 10;  // axes

// Numbers that differ between runs by more than rounding.
std::vector<Figure> figures_of(const SweepTable& table) {
  std::vector<Figure> out;
  for (const std::string& name : table.figures) {
    Figure figure{name, {}};
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const SweepRow& row : table.rows) {
      const bool has = row.done() && row.line["figures"].contains(name) && row.line["figures"][name].is_number();
      figure.of_row.push_back(has ? row.line["figures"][name].get<double>() : std::nan(""));
      if (!has) continue;
      least = std::min(least, figure.of_row.back());
      most = std::max(most, figure.of_row.back());
    }
    if (most > least && !is_flat(least, most)) out.push_back(std::move(figure));
  }
  return out;
}

using DrawPanel = std::function<void(Pen&, const PlotArea&, const Figure&)>;

// One panel per figure, row by row, as name.png and name.svg.
Status draw_picture(OutputFolder& out, const std::string& name, const std::string& title, const std::string& subtitle,
                    const std::vector<Figure>& figures, const DrawPanel& draw) {
  const std::size_t shown = std::min(figures.size(), kMostPanels);
  const int columns = static_cast<int>(std::min<std::size_t>(shown, kPlotColumns));
  const auto rows = (shown + kPlotColumns - 1) / kPlotColumns;
  const double height = kSheetTitle + kSheetRow * static_cast<double>(rows) + kSheetFoot;
  const double w = (kSheetWidth - kSheetLeft - kSheetRight - kSheetBetween * (kPlotColumns - 1)) / kPlotColumns,
               h = kSheetRow - kAbovePlot - kBelowPlot;
  const double width = std::max(kSheetLeft + kSheetRight + (w + kSheetBetween) * columns - kSheetBetween, 1100.0);
  const auto all = [&](Pen& pen) {
    pen.color(kInk);
    const double used = pen.text(kSheetLeft, 46, 24, 0, title, true);
    pen.text(kSheetLeft + used + 18, 46, 15, 0, subtitle);
    for (std::size_t i = 0; i < shown; ++i)
      draw(pen,
           {kSheetLeft + (w + kSheetBetween) * static_cast<double>(i % kPlotColumns),
            kSheetTitle + kSheetRow * static_cast<double>(i / kPlotColumns) + kAbovePlot, w, h},
           figures[i]);
  };
  const auto png = out.stage(name + ".png"), svg = out.stage(name + ".svg");
  return draw_png_and_svg(png, svg, width, height, all);
}

// The axis name as part of a file name.
std::string plain(const std::string& axis) {
  std::string out = axis.starts_with("--") ? axis.substr(2) : axis;
  if (out.starts_with("*.")) out = "all" + out.substr(1);
  for (char& c : out)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-' && c != '_') c = '_';
  return out.substr(0, 60);
}

}  // namespace

Result<std::size_t> plot_sweep(const SweepTable& table, OutputFolder& out, const Interrupt& interrupt,
                               std::string& left_out) {
  const std::vector<Figure> figures = figures_of(table);
  std::size_t plots = 0, maps = 0, pairs = 0;
  if (figures.empty()) return plots;
  std::set<std::string> names;
  const auto free_name = [&](const std::string& wanted) {
    std::string name = wanted;
    for (int n = 2; !names.insert(name).second; ++n) name = wanted + "-" + std::to_string(n);
    return name;
  };
  const auto level = table.sweep["level"].get<std::string>();
  std::size_t done = 0;
  for (const SweepRow& row : table.rows) done += row.done();
  const std::string runs = fmt::format("; {} run{}", done, done == 1 ? "" : "s");
  const std::string dots = done > kMostDots ? fmt::format("{} runs as dots, at most", kMostDots) : "every run";
  std::vector<AxisValues> along;
  std::vector<std::size_t> varied;
  for (std::size_t a = 0; a < table.axes.size(); ++a) {
    along.push_back(values_along(table, a));
    if (along[a].steps.size() > 1) varied.push_back(a);
  }
  for (const std::size_t a : varied) {
    if (plots == kMostCurves || interrupt.requested()) break;
    const bool sampled = table.axes[a].sampled, alone = varied.size() == 1;
    const std::string subtitle = "along " + table.axes[a].name +
                                 (sampled ? ": " + dots
                                  : alone ? ""
                                          : ": the mean over the other axes, and their range shaded") +
                                 runs;
    const Status ok = draw_picture(out, free_name("curves-" + plain(table.axes[a].name)), level, subtitle, figures,
                                   [&](Pen& pen, const PlotArea& area, const Figure& figure) {
                                     draw_curve(pen, area, figure, along[a], sampled);
                                   });
    if (!ok) return ok.error();
    ++plots;
  }
  for (std::size_t i = 0; i < varied.size(); ++i)
    for (std::size_t j = i + 1; j < varied.size(); ++j) {
      if (++pairs > kMostMaps || interrupt.requested()) continue;
      const std::size_t a = varied[i], b = varied[j];
      const bool sampled = table.axes[a].sampled || table.axes[b].sampled;
      std::vector<Figure> uneven;
      for (const Figure& figure : figures)
        if (!is_flat(figure, along[a], along[b], sampled)) uneven.push_back(figure);
      if (uneven.empty()) continue;
      const std::string subtitle = (sampled              ? dots
                                    : varied.size() == 2 ? ""
                                                         : "the mean over the other axes") +
                                   (sampled || varied.size() > 2 ? runs : runs.substr(2));
      const Status ok =
          draw_picture(out, free_name("map-" + plain(table.axes[a].name) + "-" + plain(table.axes[b].name)), level,
                       subtitle, uneven, [&](Pen& pen, const PlotArea& area, const Figure& figure) {
                         draw_map(pen, area, figure, along[a], along[b], sampled);
                       });
      if (!ok) return ok.error();
      ++maps;
    }
  std::vector<std::string> less;
  if (figures.size() > kMostPanels)
    less.push_back(fmt::format("each plot has the first {} of {} figures that vary", kMostPanels, figures.size()));
  if (varied.size() > kMostCurves)
    less.push_back(fmt::format("curves are along the first {} of {} axes", kMostCurves, varied.size()));
  if (pairs > kMostMaps) less.push_back(fmt::format("maps are of the first {} of {} pairs of axes", kMostMaps, pairs));
  if (done > kMostDots && std::any_of(varied.begin(), varied.end(), [&](auto a) { return table.axes[a].sampled; }))
    less.push_back(fmt::format("at most {} of {} runs are dots", kMostDots, done));
  if (!less.empty()) left_out = fmt::format("{}; results.csv has them all", fmt::join(less, "; "));
  return plots + maps;
}

}  // namespace pliant
