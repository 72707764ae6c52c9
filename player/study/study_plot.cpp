#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "player/record/pen.h"
#include "player/record/plot.h"
#include "player/study/study_linearisation.h"

namespace pliant {
namespace {

constexpr Color kSky{0.337, 0.706, 0.914};
constexpr double kStudyWidth = 1600, kStudyHeight = 900;  // [pixel]

// The way's colour is the same in both panels.
struct Way {
  const char* name;
  Color color;
  Vector6 ForceSample::*force;
};
const std::array<Way, 4> kWays{{{"held", kVermilion, &ForceSample::held},
                                {"linear", kSky, &ForceSample::linear},
                                {"contacts", kGreen, &ForceSample::contacts},
                                {"full", kInk, &ForceSample::full}}};

struct Area {
  double x, y, w, h;  // [pixel]
};

void frame(Pen& pen, const Area& area, const std::string& across, const std::string& up) {
  pen.color(kInk);
  pen.line(area.x, area.y, area.x, area.y + area.h, 1.5);
  pen.line(area.x, area.y + area.h, area.x + area.w, area.y + area.h, 1.5);
  pen.text(area.x + area.w / 2, area.y + area.h + 44, 15, 0.5, across);
  pen.upright_text(area.x - 60, area.y + area.h / 2, 15, up);
}

void draw_forces(Pen& pen, const Area& area, const LinearisationFigures& figures) {
  const double begin = figures.samples.front().time, end = figures.samples.back().time;
  double peak = 0.0;
  for (const ForceSample& s : figures.samples) peak = std::max(peak, s.full.head<3>().norm());
  const double step_y = tick_step(peak * 1.05, 5), high = step_y * std::ceil(peak * 1.05 / step_y);
  const double step_x = tick_step(end - begin, 10);
  const auto px = [&](double t) { return area.x + area.w * (t - begin) / std::max(end - begin, 1e-9); };
  const auto py = [&](double f) { return area.y + area.h - area.h * f / high; };
  for (double t = step_x * std::ceil(begin / step_x); t <= end; t += step_x) {
    pen.color(kFaint);
    pen.line(px(t), area.y, px(t), area.y + area.h, 1);
    pen.color(kInk);
    pen.text(px(t), area.y + area.h + 20, 14, 0.5, number(t, step_x));
  }
  for (double f = 0; f <= high * (1 + 1e-9); f += step_y) {
    pen.color(kFaint);
    pen.line(area.x, py(f), area.x + area.w, py(f), 1);
    pen.color(kInk);
    pen.text(area.x - 8, py(f) + 5, 14, 1.0, number(f, step_y));
  }
  frame(pen, area, "time [s]", "force on the handle [N]");
  cairo_save(pen.get());
  cairo_rectangle(pen.get(), area.x, area.y, area.w, area.h);  // what lies above is cut off
  cairo_clip(pen.get());
  for (const Way& way : kWays) {
    pen.color(way.color, 0.9);
    cairo_set_line_width(pen.get(), way.force == &ForceSample::full ? 1.2 : 1.8);
    cairo_new_path(pen.get());
    for (const ForceSample& s : figures.samples)
      cairo_line_to(pen.get(), px(s.time), py((s.*way.force).head<3>().norm()));
    cairo_stroke(pen.get());
  }
  cairo_restore(pen.get());
  double x = area.x + area.w;
  for (auto way = kWays.rbegin(); way != kWays.rend(); ++way) {
    pen.color(kInk);
    x -= pen.text(x, area.y - 14, 14, 1.0, way->name) + 8;
    pen.color(way->color);
    pen.line(x - 26, area.y - 19, x, area.y - 19, 4);
    x -= 26 + 22;
  }
}

// Both axes by powers of ten; a way that costs or errs nothing stands on the axis.
void draw_trade(Pen& pen, const Area& area, const LinearisationFigures& figures) {
  constexpr double kCheap = -2, kDear = 5, kExact = -1, kWrong = 2.5;  // log10 of [us] and [%]
  const auto px = [&](double us) {
    return area.x + area.w * std::clamp((std::log10(std::max(us, 1e-9)) - kCheap) / (kDear - kCheap), 0.0, 1.0);
  };
  const auto py = [&](double percent) {
    return area.y + area.h -
           area.h * std::clamp((std::log10(std::max(percent, 1e-9)) - kExact) / (kWrong - kExact), 0.0, 1.0);
  };
  for (double e = kCheap; e <= kDear; e += 1) {
    pen.color(kFaint);
    pen.line(px(std::pow(10, e)), area.y, px(std::pow(10, e)), area.y + area.h, 1);
    pen.color(kInk);
    pen.text(px(std::pow(10, e)), area.y + area.h + 20, 14, 0.5, decade_number(std::pow(10, e)));
  }
  for (double e = kExact; e <= kWrong; e += 1) {
    pen.color(kFaint);
    pen.line(area.x, py(std::pow(10, e)), area.x + area.w, py(std::pow(10, e)), 1);
    pen.color(kInk);
    pen.text(area.x - 8, py(std::pow(10, e)) + 5, 14, 1.0, decade_number(std::pow(10, e)));
  }
  frame(pen, area, "cost of a tick, median to 99 % [us]", "RMS error of the force [%]");
  for (std::size_t i = 0; i < figures.methods.size(); ++i) {
    const MethodFigures& m = figures.methods[i];
    const double y = py(100.0 * m.rms_share);
    pen.color(kWays[i].color);
    pen.line(px(m.p50_us), y, px(m.p99_us), y, 4);
    cairo_arc(pen.get(), px(m.p50_us), y, 8, 0, 6.283185307179586);
    cairo_fill(pen.get());
    pen.color(kInk);
    pen.text(px(m.p99_us) + 14, y - 8, 15, px(m.p99_us) > area.x + 0.8 * area.w ? 1.0 : 0.0,
             fmt::format("{}: {:.1f} %, {} us", m.name, 100.0 * m.rms_share,
                         m.p50_us < 100 ? fmt::format("{:.3g}", m.p50_us) : fmt::format("{:.0f}", m.p50_us)));
  }
}

}  // namespace

Status plot_linearisation(const std::filesystem::path& file, const LinearisationFigures& figures) {
  Pen pen(kStudyWidth, kStudyHeight);
  pen.color(kInk);
  const double width = pen.text(84, 46, 26, 0, "linearisation", true);
  pen.text(
      84 + width + 20, 46, 16, 0,
      fmt::format("{} at {:g} x its pace: {} tetrahedra, up to {} contacts; soft step {:.1f} ms, models one step late",
                  figures.level, figures.pace, figures.tetrahedra, figures.contacts, figures.soft_step * 1e3));
  if (!figures.samples.empty()) {
    draw_forces(pen, {84, 110, kStudyWidth - 112, 330}, figures);
    draw_trade(pen, {84, 540, kStudyWidth - 112, 280}, figures);
  }
  if (!pen.save(file)) return Error{file.string(), "the plot cannot be written; check the space left"};
  return Done{};
}

}  // namespace pliant
