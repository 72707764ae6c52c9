// The log-log plot of a study: cost on x, error on y, the Pareto front as a band, every point labelled.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lab/study/pareto.h"
#include "plot/cairo_pen.h"
#include "plot/panel.h"

namespace pliant {
namespace {

constexpr double kParetoWidth = 1240, kParetoHeight = 900;          // [pixel]
constexpr double kParetoLeft = 112, kParetoRight = 40, kEdge = 30;  // [pixel] margins of the axes and of text
constexpr double kSmallText = 15, kRadius = 5.5;                    // [pixel]
constexpr double kLabelText = 18, kText = 17, kLine = 22.0;         // [pixel] titles and axes; legend and sentences
constexpr double kAboveMost = 12;  // [pixel] between the largest error and the upper edge
constexpr KeyStyle kKeys{.size = kText};
constexpr double kParetoApart = 5;  // [pixel] between labels beside each other
constexpr Color kFront{0.62, 0.62, 0.62};

struct LabelBox {
  double x0, y0, x1, y1;  // [pixel]
  double overlap(const LabelBox& other) const {
    return std::max(0.0, std::min(x1, other.x1) - std::max(x0, other.x0)) *
           std::max(0.0, std::min(y1, other.y1) - std::max(y0, other.y0));
  }
};

// Range of the positive, finite values, rounded to quarters of decades.
PlotAxis axis_of(const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values)
    if (v > 0.0 && std::isfinite(v)) low = std::min(low, std::log10(v)), high = std::max(high, std::log10(v));
  if (!(low <= high)) low = high = 0.0;
  return {std::pow(10.0, std::floor((low - 0.06) * 4.0) / 4.0), std::pow(10.0, std::ceil((high + 0.06) * 4.0) / 4.0),
          true};
}

struct Plot {
  const ParetoTable& table;
  std::vector<std::size_t> shown;
  std::vector<std::string> groups;
  std::vector<std::string> title, foot;
  PlotPanel axes{};
  double most = 0.0;  // [1] error; failures are above it, on the upper edge

  Color color(const ParetoRow& row) const {
    const auto found = std::find(groups.begin(), groups.end(), row.group);
    return series_color(static_cast<std::size_t>(found - groups.begin()));
  }
  bool failed(const ParetoRow& row) const { return !std::isfinite(row.error); }
  bool unresolved(const ParetoRow& row) const { return !failed(row) && row.error < row.floor; }
  // 1: above the axis range, -1: below it or zero, 0: inside.
  int beyond(const ParetoRow& row) const {
    if (failed(row)) return 0;
    return row.resolved() > most ? 1 : row.resolved() < axes.up.low ? -1 : 0;
  }
  double right() const { return axes.x + axes.w; }
  double bottom() const { return axes.y + axes.h; }
  double px(const ParetoRow& row) const { return std::clamp(axes.px(row.cost), axes.x, right()); }
  double py(const ParetoRow& row) const {
    return failed(row) ? axes.y : std::clamp(axes.py(std::min(row.resolved(), most)), axes.y, bottom());
  }
};

std::vector<PlotKey> keys_of(const Plot& plot) {
  std::vector<PlotKey> keys;
  for (const std::string& group : plot.groups) {
    ParetoRow row;
    row.group = group;
    keys.push_back({plot.color(row), group, KeyMark::kDot});
  }
  keys.push_back(
      {kFront, plot.table.front_by_group ? "bands: each one's Pareto front" : "Pareto front", KeyMark::kBand});
  const auto some = [&](const auto& is) {
    return std::any_of(plot.shown.begin(), plot.shown.end(), [&](std::size_t i) { return is(plot.table.rows[i]); });
  };
  if (some([&](const ParetoRow& row) { return plot.failed(row); }))
    keys.push_back({kInk, "on the upper edge: failed", KeyMark::kRing});
  if (some([&](const ParetoRow& row) { return plot.unresolved(row); }))
    keys.push_back({kInk, "open: at most this; less is not resolved", KeyMark::kRing});
  if (some([&](const ParetoRow& row) { return plot.beyond(row) > 0; }))
    keys.push_back({kInk, "beyond the axis", KeyMark::kUp});
  if (some([&](const ParetoRow& row) { return plot.beyond(row) < 0; }))
    keys.push_back({kInk, "less than the axis shows, or none", KeyMark::kDown});
  return keys;
}

// The text around the axes determines the space left for them.
Plot plot_of(Pen& pen, const ParetoTable& table) {
  Plot plot{.table = table, .shown = table.drawn, .groups = {}, .title = {}, .foot = {}};
  if (plot.shown.empty())
    for (std::size_t i = 0; i < table.rows.size(); ++i) plot.shown.push_back(i);
  std::vector<double> costs, errors;
  for (const std::size_t i : plot.shown) {
    const ParetoRow& row = table.rows[i];
    costs.push_back(row.cost);
    errors.push_back(table.most_error > 0.0 ? std::clamp(row.resolved(), table.least_error, table.most_error)
                                            : row.resolved());
    if (std::find(plot.groups.begin(), plot.groups.end(), row.group) == plot.groups.end())
      plot.groups.push_back(row.group);
  }
  plot.title = pen.lines(kLabelText, table.title, kParetoWidth - 2 * kEdge);
  for (const std::string& sentence : table.sentences)
    for (std::string& line : pen.lines(kText, sentence, kParetoWidth - 2 * kEdge)) plot.foot.push_back(std::move(line));
  plot.axes.across = axis_of(costs);
  plot.axes.up = axis_of(errors);
  plot.most = plot.axes.up.high;  // the range determines which legend entries there are
  const double keys = 80 + kLine * static_cast<double>(plot.title.size());
  const double top = place_keys(pen, kEdge, keys, kParetoWidth - kEdge, keys_of(plot), kKeys).back().y + 42;
  plot.axes.x = kParetoLeft, plot.axes.w = kParetoWidth - kParetoRight - kParetoLeft;
  plot.axes.y = top, plot.axes.h = kParetoHeight - 76 - kLine * static_cast<double>(plot.foot.size()) - top;
  plot.axes.up.high = plot.axes.up.at(1.0 + kAboveMost / (plot.axes.h - kAboveMost));
  return plot;
}

void draw_front(Pen& pen, const Plot& plot) {
  for (const std::vector<std::size_t>& front : fronts(plot.table, plot.shown)) {
    if (front.empty()) continue;
    const ParetoRow& first = plot.table.rows[front[0]];
    plot.table.front_by_group ? pen.color(plot.color(first), 0.25) : pen.color(kFront, 0.45);
    // Drawn as steps: between two points of the front, the dearer one is not yet affordable.
    std::vector<PlotPoint> steps;
    double y = plot.py(first);
    for (const std::size_t i : front) {
      const ParetoRow& row = plot.table.rows[i];
      steps.push_back({plot.px(row), y});
      steps.push_back({plot.px(row), y = plot.py(row)});
    }
    steps.push_back({plot.right(), y});
    pen.polyline(steps, plot.table.front_by_group ? 5 : 9);
  }
}

void draw_points(Pen& pen, const Plot& plot) {
  if (plot.table.joined)
    for (const std::string& group : plot.groups) {
      std::vector<PlotPoint> line;
      for (const std::size_t i : plot.shown) {
        const ParetoRow& row = plot.table.rows[i];
        if (row.group != group) continue;
        pen.color(plot.color(row), 0.55);
        if (!plot.failed(row)) line.push_back({plot.px(row), plot.py(row)});
      }
      pen.polyline(line, 1.3);
    }
  for (const std::size_t i : plot.shown) {
    const ParetoRow& row = plot.table.rows[i];
    const double x = plot.px(row), y = plot.py(row);
    const bool open = plot.failed(row) || plot.unresolved(row);
    const int beyond = plot.beyond(row);
    pen.color(open && beyond == 0 ? kPaper : plot.color(row));
    beyond == 0 ? pen.disc(x, y, kRadius) : draw_arrow(pen, x, y, kRadius, beyond > 0);
    pen.color(plot.color(row));
    if (open && beyond == 0) pen.ring(x, y, kRadius, 1.5);
  }
}

struct Stretch {
  double x0, y0, x1, y1;                     // [pixel]
  bool crosses(const LabelBox& box) const {  // clips the line to the box's width, then to its height
    double from = 0.0, to = 1.0;
    for (const auto& [begin, way, low, high] :
         {std::array{x0, x1 - x0, box.x0, box.x1}, std::array{y0, y1 - y0, box.y0, box.y1}}) {
      if (way == 0.0) {
        if (begin < low || begin > high) return false;
        continue;
      }
      const double a = (low - begin) / way, b = (high - begin) / way;
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    return from < to;
  }
};

// Segments of the joined points and of the fronts.
std::vector<Stretch> drawn_lines(const Plot& plot) {
  std::vector<Stretch> lines;
  if (plot.table.joined)
    for (const std::string& group : plot.groups) {
      const ParetoRow* last = nullptr;
      for (const std::size_t i : plot.shown) {
        const ParetoRow& row = plot.table.rows[i];
        if (row.group != group || plot.failed(row)) continue;
        if (last) lines.push_back({plot.px(*last), plot.py(*last), plot.px(row), plot.py(row)});
        last = &row;
      }
    }
  for (const std::vector<std::size_t>& front : fronts(plot.table, plot.shown)) {
    for (std::size_t k = 0; k < front.size(); ++k) {
      const ParetoRow& row = plot.table.rows[front[k]];
      const double x = plot.px(row), y = plot.py(row);
      const double next = k + 1 < front.size() ? plot.px(plot.table.rows[front[k + 1]]) : plot.right();
      lines.push_back({x, y, next, y});
      if (k + 1 < front.size()) lines.push_back({next, y, next, plot.py(plot.table.rows[front[k + 1]])});
    }
  }
  return lines;
}

// Places each label near its point, where it covers the fewest points, lines and labels; a thin line connects a distant
// label.
void draw_labels(Pen& pen, const Plot& plot) {
  constexpr double kLed = 12;  // [pixel] beyond this distance a line connects label and point
  std::vector<LabelBox> taken;
  for (const std::size_t i : plot.shown) {
    const double x = plot.px(plot.table.rows[i]), y = plot.py(plot.table.rows[i]);
    taken.push_back({x - kRadius - 1, y - kRadius - 1, x + kRadius + 1, y + kRadius + 1});
  }
  std::vector<Stretch> lines = drawn_lines(plot);
  std::vector<LabelBox> placed;
  for (const std::size_t i : plot.shown) {
    const ParetoRow& row = plot.table.rows[i];
    const double x = plot.px(row), y = plot.py(row), w = pen.width(kSmallText, row.label), h = kSmallText;
    double least = std::numeric_limits<double>::infinity();
    LabelBox best{};
    for (const double far : {9.0, 16.0, 26.0, 40.0, 58.0, 80.0, 110.0, 150.0})
      for (int turn = 0; turn < 16; ++turn) {
        const double angle = turn * 0.39269908169872414, cx = x + far * std::cos(angle), cy = y - far * std::sin(angle);
        const double left = cx - w * 0.5 * (1.0 - std::cos(angle)), top = cy - h * 0.5 * (1.0 + std::sin(angle));
        const LabelBox box{left, top, left + w, top + h};
        double cost = 0.02 * far;
        for (const LabelBox& other : taken)
          cost += box.overlap({other.x0 - kParetoApart, other.y0 - 1, other.x1 + kParetoApart, other.y1 + 1});
        const Stretch lead{x, y, std::clamp(x, box.x0, box.x1), std::clamp(y, box.y0, box.y1)};
        if (std::hypot(lead.x1 - x, lead.y1 - y) > kLed)
          for (const LabelBox& other : placed) cost += 3.0 * lead.crosses(other);
        if (box.x0 < kParetoLeft + 3 || box.x1 > kParetoWidth - 4 || box.y0 < plot.axes.y - 34 ||
            box.y1 > plot.bottom() - 2)
          cost += 1e4;
        for (const Stretch& line : lines) cost += 0.6 * line.crosses(box);
        if (cost < least) least = cost, best = box;
      }
    taken.push_back(best);
    const double ax = std::clamp(x, best.x0, best.x1), ay = std::clamp(y, best.y0, best.y1);
    if (std::hypot(ax - x, ay - y) > kLed) {
      pen.color(plot.color(row));
      pen.line(x, y, ax, ay, 0.8);
      lines.push_back({x, y, ax, ay});
    }
    placed.push_back(best);
  }
  for (std::size_t k = 0; k < placed.size(); ++k) {
    pen.color(kInk);
    pen.text_over(placed[k].x0, placed[k].y1 - 2, kSmallText, 0, plot.table.rows[plot.shown[k]].label);
  }
}

void draw_heads(Pen& pen, const Plot& plot) {
  pen.color(kInk);
  pen.text(kEdge, 44, 26, 0, plot.table.study, true);
  double y = 48;
  for (const std::string& line : plot.title) pen.text(kEdge, y += kLine + 2, kLabelText, 0, line);
  draw_keys(pen, kEdge, 80 + kLine * static_cast<double>(plot.title.size()), kParetoWidth - kEdge, keys_of(plot),
            kKeys);
  y = plot.bottom() + 76;
  pen.color(kInk);
  for (const std::string& line : plot.foot) {
    pen.text(kEdge, y, kText, 0, line);
    y += kLine;
  }
}

}  // namespace

Status plot_pareto(OutputFolder& out, const std::string& stem, const ParetoTable& table) {
  return draw_png_and_svg(out.stage(stem + ".png"), out.stage(stem + ".svg"), kParetoWidth, kParetoHeight,
                          [&](Pen& pen) {
                            const Plot plot = plot_of(pen, table);
                            draw_axes(pen, plot.axes, table.cost_axis, table.error_axis,
                                      {.title = kLabelText, .most_across = 10, .most_up = 10});
                            draw_front(pen, plot);
                            draw_points(pen, plot);
                            draw_labels(pen, plot);
                            draw_heads(pen, plot);
                          });
}

}  // namespace pliant
