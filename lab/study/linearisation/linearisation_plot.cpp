#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "lab/study/linearisation/study_linearisation.h"
#include "plot/cairo_pen.h"
#include "plot/panel.h"
#include "plot/ticks.h"

namespace pliant {
namespace {

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

void draw_forces(Pen& pen, const LinearisationFigures& figures, double high) {
  const double begin = figures.samples.front().time, end = figures.samples.back().time;
  const PlotPanel panel{
      kForcesLeft, 140, kForcesWidth - kForcesLeft - 28, kForcesHeight - 140 - 70, {begin, std::max(end, begin + 1e-9)},
      {0.0, high}};
  draw_axes(pen, panel, "time [s]", "force on the handle [N]",
            {.number = kTickText, .title = kForcesText, .most_across = 10, .most_up = 5});
  std::vector<PlotKey> keys;
  for (const Way& way : kWays) {
    std::vector<PlotPoint> line;
    for (const ForceSample& s : figures.samples) line.push_back({s.time, (s.*way.force).head<3>().norm()});
    draw_line(pen, panel, line, {way.color, way.force == &ForceSample::full ? 1.2 : 1.8});
    keys.push_back({way.color, way.name});
  }
  const KeyStyle style{.size = kForcesText};
  const double right = panel.x + panel.w;
  draw_keys(pen, right - keys_width(pen, keys, style), panel.y - 18, right, keys, style);
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
        if (!figures.samples.empty()) draw_forces(pen, figures, top);
      });
}

}  // namespace pliant
