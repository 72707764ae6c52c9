#include "lab/sweep/sweep_panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "plot/ticks.h"

namespace pliant {
namespace {

constexpr double kBar = 16, kBarRoom = 86;  // [pixel]
constexpr std::size_t kLongWord = 14;       // letters of a tick label
// Above this number of dots a vector file embeds them as pixels, since each dot takes some 300 bytes. Above kMostDots
// they are subsampled.
constexpr std::size_t kMostVectorDots = 500;
constexpr double kDotRoom = 6;  // [pixel] margin for dots beyond their panel

Color mixed(Color a, Color b, double t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

// Viridis (van der Walt & Smith 2015) by six of its colours: uniform in lightness, in print and for most colour vision
// deficiencies.
Color heat(double share) {
  constexpr Color kStops[] = {{0.267, 0.005, 0.329}, {0.254, 0.265, 0.530}, {0.164, 0.471, 0.558},
                              {0.135, 0.659, 0.518}, {0.478, 0.821, 0.318}, {0.993, 0.906, 0.144}};
  constexpr std::size_t kLast = std::size(kStops) - 1;
  const double at = std::clamp(share, 0.0, 1.0) * kLast;
  const auto i = std::min(static_cast<std::size_t>(at), kLast - 1);
  return mixed(kStops[i], kStops[i + 1], at - static_cast<double>(i));
}

std::string short_word(const std::string& word) {
  return word.size() <= kLongWord ? word : word.substr(0, kLongWord - 2) + "..";
}

// Overlapping tick labels are thinned out.
void draw_ticks(Pen& pen, const PlotArea& area, const std::vector<std::pair<double, std::string>>& ticks, bool across,
                bool grid) {
  double last = -1e9;
  for (const auto& [share, words] : ticks) {
    const double x = area.x + area.w * share, y = area.y + area.h * (1.0 - share);
    pen.color(kFaint);
    if (grid && across) pen.line(x, area.y, x, area.y + area.h, 1);
    if (grid && !across) pen.line(area.x, y, area.x + area.w, y, 1);
    pen.color(kInk);
    const std::string shown = short_word(words);
    const double room = across ? 9.0 * static_cast<double>(shown.size()) + 6.0 : 16.0;
    const double at = across ? x : -y;
    if (at - last < room) continue;
    last = at;
    if (across)
      pen.text(x, area.y + area.h + 19, 13, 0.5, shown);
    else
      pen.text(area.x - 8, y + 5, 13, 1.0, shown);
  }
}

std::vector<std::pair<double, std::string>> shares(const PlotScale& scale) {
  auto ticks = scale.ticks();
  for (auto& [at, words] : ticks) at = scale.share(at);
  return ticks;
}

void draw_frame(Pen& pen, const PlotArea& area, const std::string& title, const std::string& across) {
  pen.color(kInk);
  pen.line(area.x, area.y, area.x, area.y + area.h, 1.5);
  pen.line(area.x, area.y + area.h, area.x + area.w, area.y + area.h, 1.5);
  pen.text(area.x, area.y - 13, 15, 0, title, true);
  pen.text(area.x + area.w / 2, area.y + area.h + 42, 14, 0.5, across);
}

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

void dot(Pen& pen, double x, double y, double radius) {
  cairo_new_path(pen.get());
  cairo_arc(pen.get(), x, y, radius, 0, 6.283185307179586);
  cairo_fill(pen.get());
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
  constexpr int kSlices = 60;
  for (int i = 0; i < kSlices; ++i) {
    const double h = area.h / kSlices;
    pen.color(heat((i + 0.5) / kSlices));
    cairo_rectangle(pen.get(), x, area.y + area.h - (i + 1) * h - 0.3, kBar, h + 0.6);
    cairo_fill(pen.get());
  }
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

Cell range_of(const std::vector<Cell>& cells) {
  Cell range;
  for (const Cell& cell : cells)
    if (cell.count > 0) range.add(cell.mean());
  return range;
}

}  // namespace

bool is_flat(const Figure& figure, const AxisValues& across, const AxisValues& up, bool sampled) {
  const Cell range = range_of(cells_of(figure, across, up, sampled));
  return range.count == 0 || pliant::is_flat(range.least, range.most);
}

void draw_curve(Pen& pen, const PlotArea& area, const Figure& figure, const AxisValues& axis, bool sampled) {
  std::vector<double> values;
  for (const double value : figure.of_row)
    if (std::isfinite(value)) values.push_back(value);
  const PlotScale up = scale_of(values);
  const auto px = [&](double v) { return area.x + area.w * axis.scale.share(v); };
  const auto py = [&](double v) { return area.y + area.h * (1.0 - up.share(v)); };
  draw_ticks(pen, area, shares(axis.scale), true, true);
  draw_ticks(pen, area, shares(up), false, true);
  draw_frame(pen, area, figure.name, axis.caption);
  if (sampled) {
    draw_run_dots(pen, area, figure, [&](Pen& on, std::size_t row) {
      on.color(kBlue, 0.75);
      dot(on, px(axis.of_row[row]), py(figure.of_row[row]), 3.5);
    });
    return;
  }
  std::vector<Cell> cells(axis.steps.size());
  for (std::size_t row = 0; row < figure.of_row.size(); ++row)
    if (std::isfinite(figure.of_row[row])) cells[step_of(axis, row)].add(figure.of_row[row]);
  std::vector<std::size_t> steps;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i].count > 0) steps.push_back(i);
  pen.color(kBlue, 0.18);
  cairo_new_path(pen.get());
  for (const std::size_t i : steps) cairo_line_to(pen.get(), px(axis.steps[i]), py(cells[i].most));
  for (auto i = steps.rbegin(); i != steps.rend(); ++i)
    cairo_line_to(pen.get(), px(axis.steps[*i]), py(cells[*i].least));
  cairo_fill(pen.get());
  pen.color(kBlue);
  cairo_set_line_width(pen.get(), 2.2);
  cairo_set_line_join(pen.get(), CAIRO_LINE_JOIN_ROUND);
  cairo_new_path(pen.get());
  for (const std::size_t i : steps) cairo_line_to(pen.get(), px(axis.steps[i]), py(cells[i].mean()));
  cairo_stroke(pen.get());
  for (const std::size_t i : steps) dot(pen, px(axis.steps[i]), py(cells[i].mean()), steps.size() > 60 ? 1.5 : 3.5);
}

void draw_map(Pen& pen, PlotArea area, const Figure& figure, const AxisValues& across, const AxisValues& up,
              bool sampled) {
  area.w -= kBarRoom;
  const std::size_t w = across.steps.size(), h = up.steps.size();
  const std::vector<Cell> cells = cells_of(figure, across, up, sampled);
  const Cell range = range_of(cells);
  const auto share = [&](double v) {
    return range.most > range.least ? (v - range.least) / (range.most - range.least) : 0.5;
  };
  std::vector<std::pair<double, std::string>> ticks_x = shares(across.scale), ticks_y = shares(up.scale);
  if (!sampled) {
    ticks_x.clear();
    ticks_y.clear();
    const auto middle = [](std::size_t i, std::size_t n) {
      return (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    };
    for (std::size_t i = 0; i < w; ++i) ticks_x.emplace_back(middle(i, w), across.names[i]);
    for (std::size_t i = 0; i < h; ++i) ticks_y.emplace_back(middle(i, h), up.names[i]);
  }
  draw_ticks(pen, area, ticks_x, true, sampled);
  draw_ticks(pen, area, ticks_y, false, sampled);
  const double cw = area.w / static_cast<double>(w), ch = area.h / static_cast<double>(h);
  if (sampled)
    draw_run_dots(pen, area, figure, [&](Pen& on, std::size_t row) {
      on.color(heat(share(figure.of_row[row])));
      dot(on, area.x + area.w * across.scale.share(across.of_row[row]),
          area.y + area.h * (1.0 - up.scale.share(up.of_row[row])), 5);
    });
  for (std::size_t i = 0; i < cells.size() && !sampled; ++i) {
    if (cells[i].count == 0) continue;
    const double value = cells[i].mean();
    pen.color(heat(share(value)));
    const double x = area.x + cw * static_cast<double>(i % w),
                 y = area.y + area.h - ch * static_cast<double>(i / w + 1);
    cairo_set_antialias(pen.get(), CAIRO_ANTIALIAS_NONE);  // no seams between cells
    cairo_rectangle(pen.get(), x, y, cw, ch);
    cairo_fill(pen.get());
    cairo_set_antialias(pen.get(), CAIRO_ANTIALIAS_DEFAULT);
    if (cw < 52 || ch < 18) continue;
    pen.color(share(value) > 0.55 ? kInk : kPaper);
    pen.text(x + cw / 2, y + ch / 2 + 5, 13, 0.5, short_number(value));
  }
  draw_frame(pen, area, figure.name, across.caption);
  pen.color(kInk);
  pen.upright_text(area.x - 64, area.y + area.h / 2, 14, up.caption);
  if (range.count > 0) draw_bar(pen, area, range.least, range.most);
}

}  // namespace pliant
