#include "lab/sweep/sweep_panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "plot/panel.h"
#include "plot/ticks.h"

namespace pliant {
namespace {

constexpr double kBar = 16, kBarRoom = 86;  // [pixel]
constexpr double kUsualLabel = 48;          // [pixel] width of labels beside a map that its margin has room for
// Above this number of dots a vector file embeds them as pixels, since each dot takes some 300 bytes. Above kMostDots
// they are subsampled.
constexpr std::size_t kMostVectorDots = 500;
constexpr double kDotRoom = 6;  // [pixel] margin for dots beyond their panel

const AxesStyle kSweepAxes{.number = 13, .title = 14, .most_across = 5, .most_up = 5};

// Calls draw(pen, row) for every row that has the figure; for every n-th if there are very many.
template <class Draw>
void draw_run_dots(Pen& pen, const PlotArea& area, const Figure& figure, const Draw& draw) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < figure.of_row.size(); ++row)
    if (std::isfinite(figure.of_row[row])) rows.push_back(row);
  const std::size_t every = (rows.size() + kMostDots - 1) / kMostDots;
  const auto all = [&](Pen& on) {
    for (std::size_t i = 0; i < rows.size(); i += every) draw(on, rows[i]);
  };
  if (rows.size() <= kMostVectorDots) return all(pen);
  pen.as_pixels(area.x - kDotRoom, area.y - kDotRoom, area.w + 2 * kDotRoom, area.h + 2 * kDotRoom, all);
}

struct Cell {
  double least = std::numeric_limits<double>::infinity(), most = -least, sum = 0.0;
  std::size_t count = 0;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
    sum += value;
    ++count;
  }
  double mean() const { return sum / static_cast<double>(count); }
};

std::size_t step_of(const AxisValues& axis, std::size_t row) {
  return static_cast<std::size_t>(std::lower_bound(axis.steps.begin(), axis.steps.end(), axis.of_row[row]) -
                                  axis.steps.begin());
}

void draw_bar(Pen& pen, const PlotArea& area, double least, double most) {
  const double x = area.x + area.w + 14;
  draw_color_bar(pen, {x, area.y, kBar, area.h}, true, heat);
  pen.color(kInk);
  pen.text(x + kBar + 5, area.y + 11, 13, 0, short_number(most));
  pen.text(x + kBar + 5, area.y + area.h, 13, 0, short_number(least));
}

// For two axes of steps one cell per pair, row by row from below; for samples one per run.
std::vector<Cell> cells_of(const Figure& figure, const AxisValues& across, const AxisValues& up, bool sampled) {
  const std::size_t w = across.steps.size(), h = up.steps.size();
  std::vector<Cell> cells(sampled ? figure.of_row.size() : w * h);
  for (std::size_t row = 0; row < figure.of_row.size(); ++row)
    if (std::isfinite(figure.of_row[row]))
      cells[sampled ? row : step_of(up, row) * w + step_of(across, row)].add(figure.of_row[row]);
  return cells;
}

Cell span_of(const std::vector<Cell>& cells) {
  Cell span;
  for (const Cell& cell : cells)
    if (cell.count > 0) span.add(cell.mean());
  return span;
}

}  // namespace

bool is_flat(const Figure& figure, const AxisValues& across, const AxisValues& up, bool sampled) {
  const Cell span = span_of(cells_of(figure, across, up, sampled));
  return span.count == 0 || pliant::is_flat(span.least, span.most);
}

void draw_curve(Pen& pen, const PlotArea& area, const Figure& figure, const AxisValues& axis, bool sampled) {
  std::vector<double> values;
  for (const double value : figure.of_row)
    if (std::isfinite(value)) values.push_back(value);
  const PlotPanel panel{area.x, area.y, area.w, area.h, axis.scale, scale_of(values)};
  draw_axes(pen, panel, axis.caption, "", kSweepAxes);
  pen.text(area.x, area.y - 13, 15, 0, figure.name, true);
  if (sampled) {
    draw_run_dots(pen, area, figure, [&](Pen& on, std::size_t row) {
      draw_dots(on, panel, std::array{PlotPoint{axis.of_row[row], figure.of_row[row]}}, kBlue, 3.5, true, 0.75);
    });
    return;
  }
  std::vector<Cell> cells(axis.steps.size());
  for (std::size_t row = 0; row < figure.of_row.size(); ++row)
    if (std::isfinite(figure.of_row[row])) cells[step_of(axis, row)].add(figure.of_row[row]);
  std::vector<PlotPoint> least, most, mean;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].count == 0) continue;
    least.push_back({axis.steps[i], cells[i].least});
    most.push_back({axis.steps[i], cells[i].most});
    mean.push_back({axis.steps[i], cells[i].mean()});
  }
  draw_band(pen, panel, least, most, kBlue, 0.18);
  draw_line(pen, panel, mean, {kBlue, 2.2});
  draw_dots(pen, panel, mean, kBlue, mean.size() > 60 ? 1.5 : 3.5, true);
}

void draw_map(Pen& pen, PlotArea area, const Figure& figure, const AxisValues& across, const AxisValues& up,
              bool sampled) {
  double widest = kUsualLabel;
  for (const std::string& word : (sampled ? up.scale : words_axis(up.names)).words)
    widest = std::max(widest, pen.width(kSweepAxes.number, word));
  area.x += widest - kUsualLabel;
  area.w -= widest - kUsualLabel + kBarRoom;
  const std::size_t w = across.steps.size(), h = up.steps.size();
  const std::vector<Cell> cells = cells_of(figure, across, up, sampled);
  const Cell span = span_of(cells);
  const auto color = [&](double value) {
    return heat(span.most > span.least ? (value - span.least) / (span.most - span.least) : 0.5);
  };
  PlotPanel panel{area.x, area.y, area.w, area.h, across.scale, up.scale};
  AxesStyle style = kSweepAxes;
  if (!sampled) {
    panel.across = words_axis(across.names);
    panel.up = words_axis(up.names);
    style.grid_alpha = 0.0;
    draw_cells(pen, area, w, h, [&](std::size_t i, std::size_t j) {
      const Cell& cell = cells[j * w + i];
      return cell.count > 0 ? std::optional(color(cell.mean())) : std::nullopt;
    });
  }
  draw_axes(pen, panel, across.caption, up.caption, style);
  pen.text(area.x, area.y - 13, 15, 0, figure.name, true);
  if (sampled)
    draw_run_dots(pen, area, figure, [&](Pen& on, std::size_t row) {
      draw_dots(on, panel, std::array{PlotPoint{across.of_row[row], up.of_row[row]}}, color(figure.of_row[row]), 5,
                true);
    });
  const bool labelled = area.w >= 52 * static_cast<double>(w) && area.h >= 18 * static_cast<double>(h);
  for (std::size_t i = 0; i < cells.size() && !sampled && labelled; ++i) {
    if (cells[i].count == 0) continue;
    const double value = cells[i].mean();
    const PlotPoint middle = panel.on({static_cast<double>(i % w), static_cast<double>(i / w)});
    pen.color(value > span.least + 0.55 * (span.most - span.least) ? kInk : kPaper);
    pen.text(middle.x, middle.y + 5, 13, 0.5, short_number(value));
  }
  if (span.count > 0) draw_bar(pen, area, span.least, span.most);
}

}  // namespace pliant
