// The log-log plot of a study: cost across, error up, the Pareto front as a band of its own, every point labelled.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "player/record/pen.h"
#include "player/study/pareto.h"

namespace pliant {
namespace {

constexpr double kWidth = 1600, kHeight = 1000;                       // [pixel]
constexpr double kLeft = 96, kRight = 40, kTop = 118, kBottom = 172;  // [pixel] margins
constexpr double kSmall = 12.5, kRadius = 5;                          // [pixel]
constexpr Color kSky{0.337, 0.706, 0.914}, kFront{0.62, 0.62, 0.62};
constexpr std::array kColors{kBlue, kVermilion, kGreen, kPurple, kOrange, kSky, kInk, Color{0.55, 0.55, 0.0}};

struct Box {
  double x0, y0, x1, y1;  // [pixel]
  double overlap(const Box& other) const {
    return std::max(0.0, std::min(x1, other.x1) - std::max(x0, other.x0)) *
           std::max(0.0, std::min(y1, other.y1) - std::max(y0, other.y0));
  }
};

struct Axis {
  double low = 0.0, high = 1.0;   // log10
  double begin = 0.0, end = 1.0;  // [pixel]
  double at(double value) const {
    const double share = (std::log10(std::max(value, 1e-300)) - low) / (high - low);
    return begin + (end - begin) * std::clamp(share, 0.0, 1.0);
  }
};

// Quarters of decades around the positive, finite values.
Axis axis_of(const std::vector<double>& values, double begin, double end) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double v : values)
    if (v > 0.0 && std::isfinite(v)) low = std::min(low, std::log10(v)), high = std::max(high, std::log10(v));
  if (!(low <= high)) low = high = 0.0;
  low = std::floor((low - 0.06) * 4.0) / 4.0;
  high = std::ceil((high + 0.06) * 4.0) / 4.0;
  return {low, high, begin, end};
}

struct Plot {
  const ParetoTable& table;
  std::vector<std::size_t> shown;
  std::vector<std::string> groups;
  Axis x, y;

  Color color(const ParetoRow& row) const {
    const auto found = std::find(groups.begin(), groups.end(), row.group);
    return kColors[static_cast<std::size_t>(found - groups.begin()) % kColors.size()];
  }
  bool failed(const ParetoRow& row) const { return !std::isfinite(row.error); }
  double px(const ParetoRow& row) const { return x.at(row.cost); }
  double py(const ParetoRow& row) const { return failed(row) ? kTop : y.at(row.error); }
};

Plot plot_of(const ParetoTable& table) {
  Plot plot{table, table.drawn, {}, {}, {}};
  if (plot.shown.empty())
    for (std::size_t i = 0; i < table.rows.size(); ++i) plot.shown.push_back(i);
  std::vector<double> costs, errors;
  for (const std::size_t i : plot.shown) {
    const ParetoRow& row = table.rows[i];
    costs.push_back(row.cost);
    errors.push_back(table.most_error > 0.0 ? std::clamp(row.error, table.least_error, table.most_error) : row.error);
    if (std::find(plot.groups.begin(), plot.groups.end(), row.group) == plot.groups.end())
      plot.groups.push_back(row.group);
  }
  plot.x = axis_of(costs, kLeft, kWidth - kRight);
  plot.y = axis_of(errors, kHeight - kBottom, kTop + 12);
  return plot;
}

void draw_grid(Pen& pen, const Plot& plot) {
  const double bottom = kHeight - kBottom, right = kWidth - kRight;
  for (const bool across : {true, false}) {
    const Axis& axis = across ? plot.x : plot.y;
    for (int decade = static_cast<int>(std::floor(axis.low)); decade <= axis.high + 1e-9; ++decade)
      for (const int factor : {1, 2, 5}) {
        const double value = factor * std::pow(10.0, decade), e = std::log10(value);
        if (e < axis.low - 1e-9 || e > axis.high + 1e-9) continue;
        if (factor != 1 && axis.high - axis.low > 3.2) continue;
        const double p = axis.at(value);
        pen.color(kFaint, factor == 1 ? 1.0 : 0.5);
        across ? pen.line(p, kTop, p, bottom, 1) : pen.line(kLeft, p, right, p, 1);
        pen.color(kInk);
        const std::string words = fmt::format("{:g}", value);
        across ? pen.text(p, bottom + 20, 14, 0.5, words) : pen.text(kLeft - 8, p + 5, 14, 1.0, words);
      }
  }
  pen.color(kInk);
  pen.line(kLeft, kTop, kLeft, bottom, 1.5);
  pen.line(kLeft, bottom, right, bottom, 1.5);
  pen.text((kLeft + right) / 2, bottom + 46, 16, 0.5, plot.table.cost_axis);
  pen.upright_text(28, (kTop + bottom) / 2, 16, plot.table.error_axis);
}

void draw_front(Pen& pen, const Plot& plot) {
  for (const std::vector<std::size_t>& front : fronts(plot.table, plot.shown)) {
    if (front.empty()) continue;
    const ParetoRow& first = plot.table.rows[front[0]];
    plot.table.front_by_group ? pen.color(plot.color(first), 0.25) : pen.color(kFront, 0.45);
    cairo_set_line_width(pen.get(), plot.table.front_by_group ? 5 : 9);
    cairo_set_line_join(pen.get(), CAIRO_LINE_JOIN_ROUND);
    cairo_new_path(pen.get());
    // In steps: between two of its points the dearer one is not to be had yet.
    double y = plot.py(first);
    cairo_move_to(pen.get(), plot.px(first), y);
    for (const std::size_t i : front) {
      const ParetoRow& row = plot.table.rows[i];
      cairo_line_to(pen.get(), plot.px(row), y);
      cairo_line_to(pen.get(), plot.px(row), y = plot.py(row));
    }
    cairo_line_to(pen.get(), kWidth - kRight, y);
    cairo_stroke(pen.get());
  }
}

void draw_points(Pen& pen, const Plot& plot) {
  for (const std::string& group : plot.groups) {
    cairo_new_path(pen.get());
    for (const std::size_t i : plot.shown) {
      const ParetoRow& row = plot.table.rows[i];
      if (row.group != group) continue;
      pen.color(plot.color(row), 0.55);
      if (!plot.failed(row)) cairo_line_to(pen.get(), plot.px(row), plot.py(row));
    }
    cairo_set_line_width(pen.get(), 1.3);
    if (plot.table.joined) cairo_stroke(pen.get());
    cairo_new_path(pen.get());
  }
  for (const std::size_t i : plot.shown) {
    const ParetoRow& row = plot.table.rows[i];
    pen.color(plot.color(row));
    cairo_arc(pen.get(), plot.px(row), plot.py(row), kRadius, 0, 6.283185307179586);
    cairo_set_line_width(pen.get(), 1.5);
    plot.failed(row) ? cairo_stroke(pen.get()) : cairo_fill(pen.get());
  }
}

// Each label where it covers least of points and other labels, near its point; a thin line leads to it from afar.
void draw_labels(Pen& pen, const Plot& plot) {
  std::vector<Box> taken;
  for (const std::size_t i : plot.shown) {
    const double x = plot.px(plot.table.rows[i]), y = plot.py(plot.table.rows[i]);
    taken.push_back({x - kRadius - 1, y - kRadius - 1, x + kRadius + 1, y + kRadius + 1});
  }
  for (const std::size_t i : plot.shown) {
    const ParetoRow& row = plot.table.rows[i];
    const double x = plot.px(row), y = plot.py(row), w = pen.width(kSmall, row.label), h = kSmall;
    double least = std::numeric_limits<double>::infinity();
    Box best{};
    for (const double far : {9.0, 16.0, 26.0, 40.0, 58.0, 80.0, 110.0, 150.0})
      for (int turn = 0; turn < 16; ++turn) {
        const double angle = turn * 0.39269908169872414, cx = x + far * std::cos(angle), cy = y - far * std::sin(angle);
        const double left = cx - w * 0.5 * (1.0 - std::cos(angle)), top = cy - h * 0.5 * (1.0 + std::sin(angle));
        const Box box{left, top, left + w, top + h};
        double cost = 0.02 * far;
        for (const Box& other : taken) cost += box.overlap({other.x0 - 1, other.y0 - 1, other.x1 + 1, other.y1 + 1});
        if (box.x0 < kLeft + 3 || box.x1 > kWidth - 4 || box.y0 < kTop - 24 || box.y1 > kHeight - kBottom - 2)
          cost += 1e4;
        if (cost < least) least = cost, best = box;
      }
    taken.push_back(best);
    const double ax = std::clamp(x, best.x0, best.x1), ay = std::clamp(y, best.y0, best.y1);
    pen.color(plot.color(row), 0.6);
    if (std::hypot(ax - x, ay - y) > 14) pen.line(x, y, ax, ay, 0.7);
    pen.color(kInk);
    pen.text(best.x0, best.y1 - 2, kSmall, 0, row.label);
  }
}

void draw_heads(Pen& pen, const Plot& plot) {
  pen.color(kInk);
  const double width = pen.text(kLeft, 44, 26, 0, plot.table.study, true);
  pen.text(kLeft + width + 18, 44, 16, 0, plot.table.title);
  double x = kLeft, y = 76;
  // What the points, front and circles are.
  const auto entry = [&](const std::string& words, Color color, bool line) {
    const double w = pen.width(15, words) + 46;
    if (x + w > kWidth - kRight) x = kLeft, y += 22;
    pen.color(color, line ? 0.45 : 1.0);
    if (line) {
      pen.line(x, y - 5, x + 22, y - 5, 9);
    } else {
      cairo_arc(pen.get(), x + 11, y - 5, kRadius + 1, 0, 6.283185307179586);
      cairo_fill(pen.get());
    }
    pen.color(kInk);
    pen.text(x + 28, y, 15, 0, words);
    x += w;
  };
  for (const std::string& group : plot.groups) {
    ParetoRow row;
    row.group = group;
    entry(group, plot.color(row), false);
  }
  entry(plot.table.front_by_group ? "bands: each one's Pareto front" : "Pareto front", kFront, true);
  for (const std::size_t i : plot.shown)
    if (plot.failed(plot.table.rows[i])) {
      entry("open circles at the top: failed", kPaper, true);
      break;
    }
  double foot = kHeight - kBottom + 74;
  pen.color(kInk);
  for (const std::string& sentence : plot.table.sentences) {
    for (const std::string& line : pen.lines(15, sentence, kWidth - kLeft - kRight)) {
      pen.text(kLeft, foot, 15, 0, line);
      foot += 19;
    }
  }
}

}  // namespace

Status plot_pareto(OutputFolder& out, const std::string& stem, const ParetoTable& table) {
  const Plot plot = plot_of(table);
  return draw_png_and_svg(out.stage(stem + ".png"), out.stage(stem + ".svg"), kWidth, kHeight, [&](Pen& pen) {
    draw_grid(pen, plot);
    draw_front(pen, plot);
    draw_points(pen, plot);
    draw_labels(pen, plot);
    draw_heads(pen, plot);
  });
}

}  // namespace pliant
