#include "player/sweep/sweep_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "player/record/pen.h"
#include "player/sweep/plot_scale.h"

namespace pliant {
namespace {

// [pixel]
constexpr double kWidth = 1600, kTitle = 84, kRow = 330, kFoot = 10, kLeft = 84, kRight = 28, kBetween = 100;
constexpr double kAbove = 36, kBelow = 66, kBar = 16, kBarRoom = 86;
constexpr int kColumns = 3;
constexpr std::size_t kMostPanels = 24;  // of a picture
constexpr std::size_t kMostMaps = 10;    // pairs of axes
constexpr std::size_t kLongWord = 14;    // letters of a tick

struct Area {
  double x, y, w, h;  // [pixel]
};

struct Figure {
  std::string name;
  std::vector<double> of_row;  // NaN where a run has none
};

// Numbers that are not the same in every run.
std::vector<Figure> figures_of(const SweepTable& table) {
  std::vector<Figure> out;
  for (const std::string& name : table.figures) {
    Figure figure{name, {}};
    std::set<double> seen;
    for (const SweepRow& row : table.rows) {
      const bool has = row.done() && row.line["figures"].contains(name) && row.line["figures"][name].is_number();
      figure.of_row.push_back(has ? row.line["figures"][name].get<double>() : std::nan(""));
      if (has) seen.insert(figure.of_row.back());
    }
    if (seen.size() > 1) out.push_back(std::move(figure));
  }
  return out;
}

Color mixed(Color a, Color b, double t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

// Viridis (van der Walt & Smith 2015), by six of its colours: even in lightness, in print and to nearly all eyes.
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

// Ticks that would lie on each other are thinned.
void draw_ticks(Pen& pen, const Area& area, const std::vector<std::pair<double, std::string>>& ticks, bool across,
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

void draw_frame(Pen& pen, const Area& area, const std::string& title, const std::string& across) {
  pen.color(kInk);
  pen.line(area.x, area.y, area.x, area.y + area.h, 1.5);
  pen.line(area.x, area.y + area.h, area.x + area.w, area.y + area.h, 1.5);
  pen.text(area.x, area.y - 13, 15, 0, title, true);
  pen.text(area.x + area.w / 2, area.y + area.h + 42, 14, 0.5, across);
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

// Mean over the other axes at each step, and the range in which they lie; of samples every run is a dot.
void draw_curve(Pen& pen, const Area& area, const Figure& figure, const AxisValues& axis, bool sampled) {
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
    pen.color(kBlue, 0.75);
    for (std::size_t row = 0; row < figure.of_row.size(); ++row)
      if (std::isfinite(figure.of_row[row])) dot(pen, px(axis.of_row[row]), py(figure.of_row[row]), 3.5);
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

void draw_bar(Pen& pen, const Area& area, double least, double most) {
  const double x = area.x + area.w + 14;
  constexpr int kSlices = 60;
  for (int i = 0; i < kSlices; ++i) {
    const double h = area.h / kSlices;
    pen.color(heat((i + 0.5) / kSlices));
    cairo_rectangle(pen.get(), x, area.y + area.h - (i + 1) * h - 0.3, kBar, h + 0.6);
    cairo_fill(pen.get());
  }
  pen.color(kInk);
  pen.text(x + kBar + 5, area.y + 11, 13, 0, fmt::format("{:.3g}", most));
  pen.text(x + kBar + 5, area.y + area.h, 13, 0, fmt::format("{:.3g}", least));
}

// Cells of two axes of steps, each the mean over the other axes; of samples a dot for each run.
void draw_map(Pen& pen, Area area, const Figure& figure, const AxisValues& across, const AxisValues& up, bool sampled) {
  area.w -= kBarRoom;
  const std::size_t w = across.steps.size(), h = up.steps.size();
  std::vector<Cell> cells(sampled ? figure.of_row.size() : w * h);
  for (std::size_t row = 0; row < figure.of_row.size(); ++row)
    if (std::isfinite(figure.of_row[row]))
      cells[sampled ? row : step_of(up, row) * w + step_of(across, row)].add(figure.of_row[row]);
  Cell range;
  for (const Cell& cell : cells)
    if (cell.count > 0) range.add(cell.mean());
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
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].count == 0) continue;
    const double value = cells[i].mean();
    pen.color(heat(share(value)));
    if (sampled) {
      dot(pen, area.x + area.w * across.scale.share(across.of_row[i]),
          area.y + area.h * (1.0 - up.scale.share(up.of_row[i])), 5);
      continue;
    }
    const double x = area.x + cw * static_cast<double>(i % w),
                 y = area.y + area.h - ch * static_cast<double>(i / w + 1);
    cairo_rectangle(pen.get(), x, y, cw, ch);
    cairo_fill(pen.get());
    if (cw < 52 || ch < 18) continue;
    pen.color(share(value) > 0.55 ? kInk : kPaper);
    pen.text(x + cw / 2, y + ch / 2 + 5, 13, 0.5, fmt::format("{:.3g}", value));
  }
  draw_frame(pen, area, figure.name, across.caption);
  pen.color(kInk);
  pen.upright_text(area.x - 64, area.y + area.h / 2, 14, up.caption);
  if (range.count > 0) draw_bar(pen, area, range.least, range.most);
}

using DrawPanel = std::function<void(Pen&, const Area&, const Figure&)>;

// A panel for each figure, row by row, as name.png and name.svg.
Status draw_picture(OutputFolder& out, const std::string& name, const std::string& title, const std::string& subtitle,
                    const std::vector<Figure>& figures, const DrawPanel& draw) {
  const std::size_t shown = std::min(figures.size(), kMostPanels);
  const int columns = static_cast<int>(std::min<std::size_t>(shown, kColumns));
  const auto rows = (shown + kColumns - 1) / kColumns;
  const double height = kTitle + kRow * static_cast<double>(rows) + kFoot;
  const double w = (kWidth - kLeft - kRight - kBetween * (kColumns - 1)) / kColumns, h = kRow - kAbove - kBelow;
  const double width = std::max(kLeft + kRight + (w + kBetween) * columns - kBetween, 1100.0);
  const auto all = [&](Pen& pen) {
    pen.color(kInk);
    const double used = pen.text(kLeft, 46, 24, 0, title, true);
    pen.text(kLeft + used + 18, 46, 15, 0, subtitle);
    for (std::size_t i = 0; i < shown; ++i)
      draw(pen,
           {kLeft + (w + kBetween) * static_cast<double>(i % kColumns),
            kTitle + kRow * static_cast<double>(i / kColumns) + kAbove, w, h},
           figures[i]);
  };
  const auto png = out.stage(name + ".png"), svg = out.stage(name + ".svg");
  Pen pixels(width, height), vectors(width, height, svg);
  all(pixels);
  all(vectors);
  for (const auto& [pen, file] : {std::pair(&pixels, png), {&vectors, svg}})
    if (!pen->save(file)) return Error{file.string(), "the plot cannot be written; check the space left"};
  return Done{};
}

// As a file's name has it.
std::string plain(const std::string& axis) {
  std::string out = axis.starts_with("--") ? axis.substr(2) : axis;
  if (out.starts_with("*.")) out = "all" + out.substr(1);
  for (char& c : out)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-' && c != '_') c = '_';
  return out.substr(0, 60);
}

}  // namespace

Result<std::size_t> plot_sweep(const SweepTable& table, OutputFolder& out, std::string& left_out) {
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
  std::vector<AxisValues> along;
  std::vector<std::size_t> varied;
  for (std::size_t a = 0; a < table.axes.size(); ++a) {
    along.push_back(values_along(table, a));
    if (along[a].steps.size() > 1) varied.push_back(a);
  }
  for (const std::size_t a : varied) {
    const bool sampled = table.axes[a].sampled, alone = varied.size() == 1;
    const std::string subtitle = "along " + table.axes[a].name +
                                 (sampled ? ": every run"
                                  : alone ? ""
                                          : ": the mean over the other axes, and their range shaded") +
                                 runs;
    const Status ok = draw_picture(
        out, free_name("curves-" + plain(table.axes[a].name)), level, subtitle, figures,
        [&](Pen& pen, const Area& area, const Figure& figure) { draw_curve(pen, area, figure, along[a], sampled); });
    if (!ok) return ok.error();
    ++plots;
  }
  for (std::size_t i = 0; i < varied.size(); ++i)
    for (std::size_t j = i + 1; j < varied.size(); ++j) {
      if (++pairs > kMostMaps) continue;
      const std::size_t a = varied[i], b = varied[j];
      const bool sampled = table.axes[a].sampled || table.axes[b].sampled;
      const std::string subtitle = (sampled              ? "every run"
                                    : varied.size() == 2 ? ""
                                                         : "the mean over the other axes") +
                                   (sampled || varied.size() > 2 ? runs : runs.substr(2));
      const Status ok =
          draw_picture(out, free_name("map-" + plain(table.axes[a].name) + "-" + plain(table.axes[b].name)), level,
                       subtitle, figures, [&](Pen& pen, const Area& area, const Figure& figure) {
                         draw_map(pen, area, figure, along[a], along[b], sampled);
                       });
      if (!ok) return ok.error();
      ++maps;
    }
  if (figures.size() > kMostPanels)
    left_out = fmt::format("each plot has the first {} of {} figures that vary", kMostPanels, figures.size());
  if (pairs > kMostMaps)
    left_out +=
        fmt::format("{}maps are of the first {} of {} pairs of axes", left_out.empty() ? "" : "; ", kMostMaps, pairs);
  if (!left_out.empty()) left_out += "; results.csv has them all";
  return plots + maps;
}

}  // namespace pliant
