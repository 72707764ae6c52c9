#include "plot/panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "plot/ticks.h"

namespace pliant {
namespace {

constexpr int kMostTicks = 6;

double share_of(const PanelRange& range, double value) {
  if (range.log) return std::log(std::max(value, 1e-300) / range.low) / std::log(range.high / range.low);
  return (value - range.low) / (range.high - range.low);
}

struct AxisTick {
  double value;
  std::string words;
};
std::vector<AxisTick> ticks_of(const PanelRange& range) {
  std::vector<AxisTick> out;
  if (range.log) {
    const double decades = std::log10(range.high / range.low);
    const int every = std::max(1, static_cast<int>(std::ceil(decades / 8.0)));
    for (int e = static_cast<int>(std::ceil(std::log10(range.low) - 1e-9)); e <= std::log10(range.high) + 1e-9;
         e += every)
      out.push_back({std::pow(10.0, e), decade_number(std::pow(10.0, e))});
    return out;
  }
  const double step = tick_step(range.high - range.low, kMostTicks);
  const double large = std::max(std::abs(range.low), std::abs(range.high));
  for (const double value : tick_values(range.low, range.high, step))
    out.push_back({value, large >= 1e6 || large < 1e-3 ? fmt::format("{:.3g}", value) : number(value, step)});
  return out;
}

void clip(Pen& pen, const PlotPanel& panel) {
  cairo_save(pen.get());
  cairo_rectangle(pen.get(), panel.x - 1, panel.y - 2, panel.w + 3, panel.h + 4);
  cairo_clip(pen.get());
  cairo_new_path(pen.get());
}

}  // namespace

PanelRange range_of(double least, double most, bool with_zero) {
  if (!(least <= most) || !std::isfinite(least) || !std::isfinite(most)) return {};
  if (with_zero) least = std::min(least, 0.0), most = std::max(most, 0.0);
  if (is_flat(least, most))
    return {least - 0.5 * std::max(std::abs(least), 1e-9), most + 0.5 * std::max(std::abs(most), 1e-9)};
  const double step = tick_step(most - least, kMostTicks), room = 0.03 * (most - least);
  PanelRange out{step * std::floor((least - room) / step), step * std::ceil((most + room) / step)};
  if (with_zero && least == 0.0) out.low = 0.0;
  if (with_zero && most == 0.0) out.high = 0.0;
  return out;
}

PanelRange log_range_of(double least, double most) {
  if (!(least > 0) || !(most >= least) || !std::isfinite(most)) return {1e-3, 1.0, true};
  const double low = std::pow(10.0, std::floor(std::log10(least))), high = std::pow(10.0, std::ceil(std::log10(most)));
  return {low, high > low ? high : 10.0 * low, true};
}

double PlotPanel::px(double value) const {
  return x + w * std::clamp(share_of(across, value), -10.0, 10.0);
}
double PlotPanel::py(double value) const {
  return y + h * (1.0 - std::clamp(share_of(up, value), -10.0, 10.0));
}

void draw_axes(Pen& pen, const PlotPanel& panel, const std::string& across, const std::string& up) {
  const double bottom = panel.y + panel.h, right = panel.x + panel.w;
  for (const AxisTick& tick : ticks_of(panel.across)) {
    pen.color(kFaint);
    pen.line(panel.px(tick.value), panel.y, panel.px(tick.value), bottom, 1);
    pen.color(kInk);
    pen.text(panel.px(tick.value), bottom + 20, 14, 0.5, tick.words);
  }
  double widest = 0.0;
  for (const AxisTick& tick : ticks_of(panel.up)) {
    pen.color(kFaint);
    pen.line(panel.x, panel.py(tick.value), right, panel.py(tick.value), 1);
    pen.color(kInk);
    widest = std::max(widest, pen.text(panel.x - 8, panel.py(tick.value) + 5, 14, 1.0, tick.words));
  }
  pen.line(panel.x, panel.y, panel.x, bottom, 1.5);
  pen.line(panel.x, bottom, right, bottom, 1.5);
  pen.text(panel.x + panel.w / 2, bottom + 44, 15, 0.5, across);
  pen.upright_text(panel.x - widest - 22, panel.y + panel.h / 2, 15, up);
}

void draw_line(Pen& pen, const PlotPanel& panel, const std::vector<double>& x, const std::vector<double>& y,
               Color color, double width) {
  clip(pen, panel);
  pen.color(color, 0.9);
  cairo_set_line_width(pen.get(), width);
  cairo_set_line_join(pen.get(), CAIRO_LINE_JOIN_ROUND);
  bool begun = false;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    const bool shown =
        std::isfinite(x[i]) && std::isfinite(y[i]) && (!panel.up.log || y[i] > 0) && (!panel.across.log || x[i] > 0);
    if (shown && begun) cairo_line_to(pen.get(), panel.px(x[i]), panel.py(y[i]));
    if (shown && !begun) cairo_move_to(pen.get(), panel.px(x[i]), panel.py(y[i]));
    begun = shown;
  }
  cairo_stroke(pen.get());
  cairo_restore(pen.get());
}

void draw_dots(Pen& pen, const PlotPanel& panel, const std::vector<double>& x, const std::vector<double>& y,
               Color color, double radius, bool filled) {
  clip(pen, panel);
  pen.color(color, filled ? 0.75 : 1.0);
  cairo_set_line_width(pen.get(), 1.3);
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    cairo_new_path(pen.get());
    cairo_arc(pen.get(), panel.px(x[i]), panel.py(y[i]), radius, 0, 6.283185307179586);
    filled ? cairo_fill(pen.get()) : cairo_stroke(pen.get());
  }
  cairo_restore(pen.get());
}

void draw_keys(Pen& pen, double x, double y, double right, const std::vector<PanelKey>& keys) {
  const double begin = x;
  for (const PanelKey& key : keys) {
    const double width = 34 + pen.width(14, key.words) + 22;
    if (x > begin && x + width > right) x = begin, y += 20;
    pen.color(key.color);
    if (key.dot) {
      cairo_new_path(pen.get());
      cairo_arc(pen.get(), x + 13, y - 5, 5, 0, 6.283185307179586);
      cairo_fill(pen.get());
    } else {
      pen.line(x, y - 5, x + 26, y - 5, 4);
    }
    pen.color(kInk);
    pen.text(x + 34, y, 14, 0, key.words);
    x += width;
  }
}

Color series_color(std::size_t number) {
  constexpr Color kSky{0.337, 0.706, 0.914};
  constexpr std::array kColors{kBlue, kVermilion, kGreen, kOrange, kPurple, kSky, kInk, Color{0.55, 0.55, 0.0}};
  return kColors[number % kColors.size()];
}

}  // namespace pliant
