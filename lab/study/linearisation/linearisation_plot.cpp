#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/study/linearisation/study_linearisation.h"
#include "plot/pen.h"
#include "plot/ticks.h"

namespace pliant {
namespace {

constexpr Color kSky{0.337, 0.706, 0.914};
constexpr double kForcesWidth = 1240, kForcesHeight = 620, kForcesLeft = 96;  // [pixel]
constexpr double kAboveTruth = 1.5;                 // [1] upper limit of the axis, relative to the largest true force
constexpr double kForcesText = 17, kTickText = 16;  // [pixel]

// A method has the same colour in both panels.
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
  pen.text(area.x + area.w / 2, area.y + area.h + 48, kForcesText, 0.5, across);
  pen.upright_text(area.x - 62, area.y + area.h / 2, kForcesText, up);
}

// [N] Upper end of the axis; `cut`: another method exceeds it.
double top_of(const LinearisationFigures& figures, bool& cut) {
  double truth = 0.0, all = 0.0;
  for (const ForceSample& s : figures.samples) {
    truth = std::max(truth, s.full.head<3>().norm());
    for (const Way& way : kWays) all = std::max(all, (s.*way.force).head<3>().norm());
  }
  const double most = std::min(1.05 * all, kAboveTruth * truth), step = tick_step(most, 5),
               top = step * std::ceil(most / step);
  cut = all > top;
  return top;
}

void draw_forces(Pen& pen, const Area& area, const LinearisationFigures& figures, double high) {
  const double begin = figures.samples.front().time, end = figures.samples.back().time;
  const double step_y = tick_step(high, 5);
  const double step_x = tick_step(end - begin, 10);
  const auto px = [&](double t) { return area.x + area.w * (t - begin) / std::max(end - begin, 1e-9); };
  const auto py = [&](double f) { return area.y + area.h - area.h * f / high; };
  for (double t = step_x * std::ceil(begin / step_x); t <= end; t += step_x) {
    pen.color(kFaint);
    pen.line(px(t), area.y, px(t), area.y + area.h, 1);
    pen.color(kInk);
    pen.text(px(t), area.y + area.h + 22, kTickText, 0.5, number(t, step_x));
  }
  for (double f = 0; f <= high * (1 + 1e-9); f += step_y) {
    pen.color(kFaint);
    pen.line(area.x, py(f), area.x + area.w, py(f), 1);
    pen.color(kInk);
    pen.text(area.x - 8, py(f) + 5, kTickText, 1.0, number(f, step_y));
  }
  frame(pen, area, "time [s]", "force on the handle [N]");
  cairo_save(pen.get());
  cairo_rectangle(pen.get(), area.x, area.y, area.w, area.h);  // clip what lies above
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
    x -= pen.text(x, area.y - 18, kForcesText, 1.0, way->name) + 8;
    pen.color(way->color);
    pen.line(x - 26, area.y - 24, x, area.y - 24, 4);
    x -= 26 + 22;
  }
}

}  // namespace

Status plot_linearisation(OutputFolder& out, const std::string& stem, const LinearisationFigures& figures) {
  bool cut = false;
  const double top = figures.samples.empty() ? 0.0 : top_of(figures, cut);
  return draw_png_and_svg(
      out.stage(stem + ".png"), out.stage(stem + ".svg"), kForcesWidth, kForcesHeight, [&](Pen& pen) {
        pen.color(kInk);
        pen.text(kForcesLeft, 44, 26, 0, fmt::format("linearisation, {:g} x its pace", figures.pace), true);
        pen.text(kForcesLeft, 74, kForcesText, 0,
                 fmt::format("{}: {} tetrahedra, up to {} contacts; soft steps of {:.1f} ms, models one step late{}",
                             figures.level, figures.tetrahedra, figures.contacts, figures.soft_step * 1e3,
                             cut ? "; what is above the axis is cut off" : ""));
        if (!figures.samples.empty())
          draw_forces(pen, {kForcesLeft, 140, kForcesWidth - kForcesLeft - 28, kForcesHeight - 140 - 70}, figures, top);
      });
}

}  // namespace pliant
