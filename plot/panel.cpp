#include "plot/panel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pliant {
namespace {

constexpr double kLegendRoom = 0.5;  // [pixel] by which rounding may exceed the room
constexpr double kMerged = 0.5;      // [pixel] points of a line that are nearer are one
constexpr double kMarkLong = 1.8, kMarkShort = 0.9, kMarkGap = 0.55, kApart = 1.5;  // [1] of a legend's text size

bool has_place(const PlotAxis& axis, double value) {
  return std::isfinite(value) && (!axis.log || value > 0.0);
}
bool has_place(const PlotPanel& panel, const PlotPoint& at) {
  return has_place(panel.across, at.x) && has_place(panel.up, at.y);
}

void clip_to(Pen& pen, const PlotPanel& panel) {
  pen.clip(panel.x - 1, panel.y - 2, panel.w + 3, panel.h + 4);
}

void draw_grid_line(Pen& pen, const PlotPanel& panel, const AxesStyle& style, const AxisTick& tick, bool across) {
  if (style.grid_alpha <= 0.0) return;
  pen.color(style.grid, tick.decade ? style.grid_alpha : 0.5 * style.grid_alpha);
  if (const double at = across ? panel.px(tick.value) : panel.py(tick.value); across)
    pen.line(at, panel.y, at, panel.y + panel.h, 1);
  else
    pen.line(panel.x, at, panel.x + panel.w, at, 1);
}

double apart(const AxesStyle& style) {
  return 0.45 * style.number;
}

// As many as the numbers below the panel have room for.
std::vector<AxisTick> ticks_across(Pen& pen, const PlotPanel& panel, const AxesStyle& style) {
  for (int most = style.most_across; most > 1 && style.numbers_across; --most) {
    std::vector<AxisTick> ticks = axis_ticks(panel.across, most);
    double free_from = -1e9;
    bool fit = true;
    for (const AxisTick& tick : ticks) {
      const double at = panel.px(tick.value), half = 0.5 * pen.width(style.number, tick.words);
      fit = fit && at - half >= free_from;
      free_from = at + half + apart(style);
    }
    if (fit) return ticks;
  }
  return axis_ticks(panel.across, style.numbers_across ? 1 : style.most_across);
}

void draw_numbers_across(Pen& pen, const PlotPanel& panel, const AxesStyle& style, const std::vector<AxisTick>& ticks) {
  const double base = panel.y + panel.h + style.gap + style.number;
  double free_from = -1e9, free_to = 1e9;
  pen.color(style.ink);
  if (!style.unit.empty())
    free_to = panel.x + panel.w - pen.text(panel.x + panel.w, base, style.number, 1.0, style.unit) - apart(style);
  for (const AxisTick& tick : ticks) {
    const double at = panel.px(tick.value), half = 0.5 * pen.width(style.number, tick.words);
    if (at - half < free_from || at + half > free_to) continue;
    pen.text(at, base, style.number, 0.5, tick.words);
    free_from = at + half + apart(style);
  }
}

double draw_numbers_up(Pen& pen, const PlotPanel& panel, const AxesStyle& style, const std::vector<AxisTick>& ticks) {
  double widest = 0.0, free_below = 1e9;
  pen.color(style.ink);
  for (const AxisTick& tick : ticks) {
    double base = panel.py(tick.value) + 0.36 * style.number;
    if (style.numbers_between) base = std::clamp(base, panel.y + 0.8 * style.number, panel.y + panel.h);
    if (base > free_below) continue;
    free_below = base - 1.1 * style.number;
    const double at = style.right ? panel.x + panel.w + style.gap + 2 : panel.x - style.gap - 2;
    widest = std::max(widest, pen.text(at, base, style.number, style.right ? 0.0 : 1.0, tick.words));
  }
  return widest;
}

double mark_width(const PlotKey& key, const KeyStyle& style) {
  return style.size * (key.mark < KeyMark::kDot ? kMarkLong : kMarkShort);
}

}  // namespace

double PlotPanel::px(double value) const {
  return x + w * std::clamp(across.share(value), -10.0, 10.0);
}
double PlotPanel::py(double value) const {
  return y + h * (1.0 - std::clamp(up.share(value), -10.0, 10.0));
}

double draw_axes(Pen& pen, const PlotPanel& panel, const AxesStyle& style) {
  const std::vector<AxisTick> across = ticks_across(pen, panel, style), up = axis_ticks(panel.up, style.most_up);
  for (const AxisTick& tick : across) draw_grid_line(pen, panel, style, tick, true);
  for (const AxisTick& tick : up) draw_grid_line(pen, panel, style, tick, false);
  if (style.numbers_across) draw_numbers_across(pen, panel, style, across);
  const double widest = draw_numbers_up(pen, panel, style, up);
  if (!style.lines) return widest;
  const double bottom = panel.y + panel.h, side = style.right ? panel.x + panel.w : panel.x;
  pen.color(style.ink);
  pen.line(side, panel.y, side, bottom, 1.5);
  pen.line(panel.x, bottom, panel.x + panel.w, bottom, 1.5);
  return widest;
}

void draw_axes(Pen& pen, const PlotPanel& panel, const std::string& across, const std::string& up,
               const AxesStyle& style) {
  const double widest = draw_axes(pen, panel, style);
  const double below = style.gap + style.number + 9 + style.title;
  pen.text(panel.x + panel.w / 2, panel.y + panel.h + below, style.title, 0.5, across);
  const std::vector<std::string> lines = pen.lines(style.title, up, 1.15 * panel.h);
  double x = panel.x - widest - style.gap - 16;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line, x -= 1.25 * style.title)
    pen.upright_text(x, panel.y + panel.h / 2, style.title, *line);
}

void draw_line(Pen& pen, const PlotPanel& panel, std::span<const PlotPoint> points, const LineStyle& style) {
  clip_to(pen, panel);
  pen.color(style.color, style.alpha);
  std::vector<PlotPoint> line;
  const auto finish = [&] {
    if (line.size() > 1) pen.polyline(line, style.width, style.dashed);
    line.clear();
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!has_place(panel, points[i])) {
      finish();
      continue;
    }
    const PlotPoint at = panel.on(points[i]);
    const bool ends = i + 1 == points.size() || !has_place(panel, points[i + 1]);
    if (!ends && line.size() > 1 && std::abs(at.x - line.back().x) < kMerged &&
        std::abs(at.y - line.back().y) < kMerged)
      continue;
    line.push_back(at);
  }
  finish();
  pen.unclip();
}

void draw_dots(Pen& pen, const PlotPanel& panel, std::span<const PlotPoint> points, Color color, double radius,
               bool filled, double alpha) {
  pen.color(color, alpha);
  for (const PlotPoint& point : points) {
    if (!has_place(panel, point)) continue;
    const PlotPoint at = panel.on(point);
    if (at.x < panel.x - 1 || at.x > panel.x + panel.w + 1 || at.y < panel.y - 1 || at.y > panel.y + panel.h + 1)
      continue;
    filled ? pen.disc(at.x, at.y, radius) : pen.ring(at.x, at.y, radius, 1.5);
  }
}

void draw_band(Pen& pen, const PlotPanel& panel, std::span<const PlotPoint> low, std::span<const PlotPoint> high,
               Color color, double alpha) {
  std::vector<PlotPoint> below, above;
  for (std::size_t i = 0; i < std::min(low.size(), high.size()); ++i) {
    if (!has_place(panel, low[i]) || !has_place(panel, high[i])) continue;
    below.push_back(panel.on(low[i]));
    above.push_back(panel.on(high[i]));
  }
  clip_to(pen, panel);
  pen.color(color, alpha);
  pen.fill(below, above);
  pen.unclip();
}

void draw_level(Pen& pen, const PlotPanel& panel, double y, const LineStyle& style) {
  clip_to(pen, panel);
  pen.color(style.color, style.alpha);
  pen.line(panel.x, panel.py(y), panel.x + panel.w, panel.py(y), style.width, style.dashed);
  pen.unclip();
}

void draw_upright(Pen& pen, const PlotPanel& panel, double x, const LineStyle& style) {
  clip_to(pen, panel);
  pen.color(style.color, style.alpha);
  pen.line(panel.px(x), panel.y, panel.px(x), panel.y + panel.h, style.width, style.dashed);
  pen.unclip();
}

std::vector<PlotPoint> points_of(std::span<const double> x, std::span<const double> y) {
  std::vector<PlotPoint> out;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) out.push_back({x[i], y[i]});
  return out;
}

void draw_arrow(Pen& pen, double x, double y, double radius, bool up) {
  const double tip = (up ? -1.5 : 1.5) * radius, base = y - 0.5 * tip;
  const PlotPoint point{x, y + tip};
  pen.fill(std::array{point, PlotPoint{x - 1.2 * radius, base}}, std::array{point, PlotPoint{x + 1.2 * radius, base}});
}

double key_width(Pen& pen, const PlotKey& key, const KeyStyle& style) {
  return mark_width(key, style) + kMarkGap * style.size + pen.width(style.size, key.words) + kApart * style.size;
}

double keys_width(Pen& pen, std::span<const PlotKey> keys, const KeyStyle& style) {
  double width = 0.0;
  for (const PlotKey& key : keys) width += key_width(pen, key, style);
  return width - kApart * style.size;
}

void draw_key(Pen& pen, double x, double y, const PlotKey& key, const KeyStyle& style) {
  const double s = style.size, end = x + mark_width(key, style), middle = y - 0.36 * s, centre = 0.5 * (x + end);
  pen.color(key.color, key.mark == KeyMark::kBand ? 0.45 : 1.0);
  switch (key.mark) {
    case KeyMark::kLine:
    case KeyMark::kDashed:
      pen.line(x, middle, end, middle, style.line, key.mark == KeyMark::kDashed);
      break;
    case KeyMark::kBand:
      pen.line(x, middle, end, middle, 0.6 * s);
      break;
    case KeyMark::kBox:
      pen.rectangle(x, y - 0.86 * s, end - x, s);
      break;
    case KeyMark::kDot:
      pen.disc(centre, middle, 0.36 * s);
      break;
    case KeyMark::kRing:
      pen.ring(centre, middle, 0.36 * s, 1.5);
      break;
    case KeyMark::kUp:
    case KeyMark::kDown:
      draw_arrow(pen, centre, middle, 0.36 * s, key.mark == KeyMark::kUp);
      break;
  }
  pen.color(style.ink);
  const double text = end + kMarkGap * s;
  style.over ? pen.text_over(text, y, s, 0, key.words) : pen.text(text, y, s, 0, key.words);
}

std::vector<PlotPoint> place_keys(Pen& pen, double x, double y, double right, std::span<const PlotKey> keys,
                                  const KeyStyle& style) {
  std::vector<PlotPoint> out;
  PlotPoint at{x, y};
  for (const PlotKey& key : keys) {
    const double width = key_width(pen, key, style);
    if (at.x > x && at.x + width - kApart * style.size > right + kLegendRoom) at = {x, at.y + 1.45 * style.size};
    out.push_back(at);
    at.x += width;
  }
  return out;
}

double draw_keys(Pen& pen, double x, double y, double right, const std::vector<PlotKey>& keys, const KeyStyle& style) {
  const std::vector<PlotPoint> places = place_keys(pen, x, y, right, keys, style);
  for (std::size_t i = 0; i < keys.size(); ++i) draw_key(pen, places[i].x, places[i].y, keys[i], style);
  return places.empty() ? y : places.back().y;
}

Color series_color(std::size_t number) {
  constexpr std::array kColors{kBlue, kVermilion, kGreen, kOrange, kPurple, kSky, kInk, Color{0.55, 0.55, 0.0}};
  return kColors[number % kColors.size()];
}

}  // namespace pliant
