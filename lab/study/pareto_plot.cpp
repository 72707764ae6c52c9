// The log-log plot of a study: cost on x, error on y, the Pareto front as a band, every point labelled.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lab/study/pareto.h"
#include "plot/pen.h"

namespace pliant {
namespace {

constexpr double kParetoWidth = 1240, kParetoHeight = 900;          // [pixel]
constexpr double kParetoLeft = 112, kParetoRight = 40, kEdge = 30;  // [pixel] margins of the axes and of text
constexpr double kSmallText = 15, kRadius = 5.5;                    // [pixel]
constexpr double kLabelText = 18, kText = 17, kLine = 22.0;         // [pixel] titles and axes; legend and sentences
constexpr double kApart = 5;                                        // [pixel] between labels beside each other
constexpr Color kParetoSky{0.337, 0.706, 0.914}, kFront{0.62, 0.62, 0.62};
constexpr std::array kColors{kBlue, kVermilion, kGreen, kPurple, kOrange, kParetoSky, kInk, Color{0.55, 0.55, 0.0}};

struct LabelBox {
  double x0, y0, x1, y1;  // [pixel]
  double overlap(const LabelBox& other) const {
    return std::max(0.0, std::min(x1, other.x1) - std::max(x0, other.x0)) *
           std::max(0.0, std::min(y1, other.y1) - std::max(y0, other.y0));
  }
};

struct ParetoAxis {
  double low = 0.0, high = 1.0;   // log10
  double begin = 0.0, end = 1.0;  // [pixel]
  double at(double value) const {
    const double share = (std::log10(std::max(value, 1e-300)) - low) / (high - low);
    return begin + (end - begin) * std::clamp(share, 0.0, 1.0);
  }
};

// Range of the positive, finite values, rounded to quarters of decades.
ParetoAxis axis_of(const std::vector<double>& values, double begin, double end) {
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
  std::vector<std::string> title, foot;
  double top = 0.0, bottom = 0.0;  // [pixel] of the axes
  ParetoAxis x, y;

  Color color(const ParetoRow& row) const {
    const auto found = std::find(groups.begin(), groups.end(), row.group);
    return kColors[static_cast<std::size_t>(found - groups.begin()) % kColors.size()];
  }
  bool failed(const ParetoRow& row) const { return !std::isfinite(row.error); }
  bool unresolved(const ParetoRow& row) const { return !failed(row) && row.error < row.floor; }
  // 1: above the axis range, -1: below it or zero, 0: inside.
  int beyond(const ParetoRow& row) const {
    if (failed(row)) return 0;
    const double e = std::log10(std::max(row.resolved(), 1e-300));
    return e > y.high ? 1 : e < y.low ? -1 : 0;
  }
  double px(const ParetoRow& row) const { return x.at(row.cost); }
  double py(const ParetoRow& row) const { return failed(row) ? top : y.at(row.resolved()); }
};

struct ParetoKey {
  enum class Mark : std::uint8_t { kPoint, kBand, kCircle, kUp, kDown } mark;
  std::string words;
  Color color;
};
std::vector<ParetoKey> keys_of(const Plot& plot) {
  std::vector<ParetoKey> keys;
  for (const std::string& group : plot.groups) {
    ParetoRow row;
    row.group = group;
    keys.push_back({ParetoKey::Mark::kPoint, group, plot.color(row)});
  }
  keys.push_back(
      {ParetoKey::Mark::kBand, plot.table.front_by_group ? "bands: each one's Pareto front" : "Pareto front", kFront});
  const auto some = [&](const auto& is) {
    return std::any_of(plot.shown.begin(), plot.shown.end(), [&](std::size_t i) { return is(plot.table.rows[i]); });
  };
  if (some([&](const ParetoRow& row) { return plot.failed(row); }))
    keys.push_back({ParetoKey::Mark::kCircle, "on the upper edge: failed", kInk});
  if (some([&](const ParetoRow& row) { return plot.unresolved(row); }))
    keys.push_back({ParetoKey::Mark::kCircle, "open: at most this; less is not resolved", kInk});
  if (some([&](const ParetoRow& row) { return plot.beyond(row) > 0; }))
    keys.push_back({ParetoKey::Mark::kUp, "beyond the axis", kInk});
  if (some([&](const ParetoRow& row) { return plot.beyond(row) < 0; }))
    keys.push_back({ParetoKey::Mark::kDown, "less than the axis shows, or none", kInk});
  return keys;
}

// A point, or an arrowhead if the value is outside the axis range.
void draw_mark(Pen& pen, double x, double y, int beyond, double r) {
  cairo_new_path(pen.get());
  if (beyond == 0) {
    cairo_arc(pen.get(), x, y, r, 0, 6.283185307179586);
  } else {
    const double tip = -beyond * 1.5 * r;  // the y axis points down
    cairo_move_to(pen.get(), x, y + tip);
    cairo_line_to(pen.get(), x - 1.2 * r, y - 0.5 * tip);
    cairo_line_to(pen.get(), x + 1.2 * r, y - 0.5 * tip);
    cairo_close_path(pen.get());
  }
}

// Lays out the legend in lines from `y`, draws it if `draw`, and returns the position of the last line.
double put_keys(Pen& pen, const Plot& plot, double y, bool draw) {
  double x = kEdge;
  for (const ParetoKey& key : keys_of(plot)) {
    const double w = pen.width(kText, key.words) + 50;
    if (x + w - 20 > kParetoWidth - kEdge && x > kEdge) x = kEdge, y += kLine + 2;
    if (draw) {
      pen.color(key.color, key.mark == ParetoKey::Mark::kBand ? 0.45 : 1.0);
      if (key.mark == ParetoKey::Mark::kBand) {
        pen.line(x, y - 5, x + 22, y - 5, 9);
      } else {
        draw_mark(pen, x + 11, y - 5,
                  key.mark == ParetoKey::Mark::kUp     ? 1
                  : key.mark == ParetoKey::Mark::kDown ? -1
                                                       : 0,
                  kRadius + 1);
        cairo_set_line_width(pen.get(), 1.5);
        key.mark == ParetoKey::Mark::kCircle ? cairo_stroke(pen.get()) : cairo_fill(pen.get());
      }
      pen.color(kInk);
      pen.text(x + 28, y, kText, 0, key.words);
    }
    x += w;
  }
  return y;
}

// The text around the axes determines the space left for them.
Plot plot_of(Pen& pen, const ParetoTable& table) {
  Plot plot{.table = table, .shown = table.drawn, .groups = {}, .title = {}, .foot = {}, .x = {}, .y = {}};
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
  plot.y = axis_of(errors, 0.0, 1.0);  // the range determines which legend entries there are
  plot.top = put_keys(pen, plot, 80 + kLine * static_cast<double>(plot.title.size()), false) + 42;
  plot.bottom = kParetoHeight - 76 - kLine * static_cast<double>(plot.foot.size());
  plot.x = axis_of(costs, kParetoLeft, kParetoWidth - kParetoRight);
  plot.y = axis_of(errors, plot.bottom, plot.top + 12);
  return plot;
}

void draw_grid(Pen& pen, const Plot& plot) {
  const double top = plot.top, bottom = plot.bottom, right = kParetoWidth - kParetoRight;
  for (const bool across : {true, false}) {
    const ParetoAxis& axis = across ? plot.x : plot.y;
    for (int decade = static_cast<int>(std::floor(axis.low)); decade <= axis.high + 1e-9; ++decade)
      for (const int factor : {1, 2, 5}) {
        const double value = factor * std::pow(10.0, decade), e = std::log10(value);
        if (e < axis.low - 1e-9 || e > axis.high + 1e-9) continue;
        if (factor != 1 && axis.high - axis.low > 3.2) continue;
        const double p = axis.at(value);
        pen.color(kFaint, factor == 1 ? 1.0 : 0.5);
        across ? pen.line(p, top, p, bottom, 1) : pen.line(kParetoLeft, p, right, p, 1);
        pen.color(kInk);
        const std::string words = decade_number(value);
        across ? pen.text(p, bottom + 20, 14, 0.5, words) : pen.text(kParetoLeft - 8, p + 5, 14, 1.0, words);
      }
  }
  pen.color(kInk);
  pen.line(kParetoLeft, top, kParetoLeft, bottom, 1.5);
  pen.line(kParetoLeft, bottom, right, bottom, 1.5);
  pen.text((kParetoLeft + right) / 2, bottom + 44, kLabelText, 0.5, plot.table.cost_axis);
  double x = 26;
  for (const std::string& line : pen.lines(kLabelText, plot.table.error_axis, bottom - top)) {
    pen.upright_text(x, (top + bottom) / 2, kLabelText, line);
    x += kLine;
  }
}

void draw_front(Pen& pen, const Plot& plot) {
  for (const std::vector<std::size_t>& front : fronts(plot.table, plot.shown)) {
    if (front.empty()) continue;
    const ParetoRow& first = plot.table.rows[front[0]];
    plot.table.front_by_group ? pen.color(plot.color(first), 0.25) : pen.color(kFront, 0.45);
    cairo_set_line_width(pen.get(), plot.table.front_by_group ? 5 : 9);
    cairo_set_line_join(pen.get(), CAIRO_LINE_JOIN_ROUND);
    cairo_new_path(pen.get());
    // Drawn as steps: between two points of the front, the dearer one is not yet affordable.
    double y = plot.py(first);
    cairo_move_to(pen.get(), plot.px(first), y);
    for (const std::size_t i : front) {
      const ParetoRow& row = plot.table.rows[i];
      cairo_line_to(pen.get(), plot.px(row), y);
      cairo_line_to(pen.get(), plot.px(row), y = plot.py(row));
    }
    cairo_line_to(pen.get(), kParetoWidth - kParetoRight, y);
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
    draw_mark(pen, plot.px(row), plot.py(row), plot.beyond(row), kRadius);
    cairo_set_line_width(pen.get(), 1.5);
    if (plot.failed(row) || plot.unresolved(row)) {
      cairo_save(pen.get());
      pen.color(kPaper);
      cairo_fill_preserve(pen.get());
      cairo_restore(pen.get());
      pen.color(plot.color(row));
      cairo_stroke(pen.get());
    } else {
      cairo_fill(pen.get());
    }
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
      const double next = k + 1 < front.size() ? plot.px(plot.table.rows[front[k + 1]]) : kParetoWidth - kParetoRight;
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
          cost += box.overlap({other.x0 - kApart, other.y0 - 1, other.x1 + kApart, other.y1 + 1});
        const Stretch lead{x, y, std::clamp(x, box.x0, box.x1), std::clamp(y, box.y0, box.y1)};
        if (std::hypot(lead.x1 - x, lead.y1 - y) > kLed)
          for (const LabelBox& other : placed) cost += 3.0 * lead.crosses(other);
        if (box.x0 < kParetoLeft + 3 || box.x1 > kParetoWidth - 4 || box.y0 < plot.top - 34 || box.y1 > plot.bottom - 2)
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
  put_keys(pen, plot, 80 + kLine * static_cast<double>(plot.title.size()), true);
  y = plot.bottom + 76;
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
                            draw_grid(pen, plot);
                            draw_front(pen, plot);
                            draw_points(pen, plot);
                            draw_labels(pen, plot);
                            draw_heads(pen, plot);
                          });
}

}  // namespace pliant
