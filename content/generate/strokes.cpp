#include "content/generate/strokes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/files/file_io.h"

namespace pliant::generate {
namespace {

constexpr double kRate = 100.0;  // [Hz] of rows

dvec3 along(const Solid& solid, const Stroke& stroke, double t) {
  dvec3 p = stroke.through.front();
  for (std::size_t i = 1; i < stroke.through.size(); ++i)
    p += (stroke.through[i] - stroke.through[i - 1]) * smooth_step(stroke.at[i - 1], stroke.at[i], t);
  return project(solid, p);
}

}  // namespace

Path trace(const Solid& solid, const Stroke& stroke) {
  Path path;
  const int rows = static_cast<int>(std::lround(stroke.duration * kRate));
  for (int row = 0; row <= rows; ++row) {
    const double t = row / kRate;
    const double pressed =
        smooth_step(stroke.press_from, stroke.press_to, t) - smooth_step(stroke.lift_from, stroke.lift_to, t);
    const dvec3 foot = along(solid, stroke, t);
    const double above = stroke.clearance - (stroke.clearance + stroke.depth) * pressed;
    path.rows.push_back({t, foot + normal_at(solid, foot) * (above + stroke.radius), dquat(1, 0, 0, 0)});
  }
  return path;
}

}  // namespace pliant::generate
