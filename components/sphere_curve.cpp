#include "components/sphere_curve.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "components/bonded_layer.h"

namespace pliant {
namespace {

// phi and its derivative by x at some x > 0.
struct CurvePoint {
  double x, value, slope;
};

// The integral of phi over x = s^2 is 2 s^4 g ds: in powers of t = s - at.
double phi_integral(const CubicPiece& piece, double t) {
  const double a = piece.at, s[5] = {a * a * a * a, 4 * a * a * a, 6 * a * a, 4 * a, 1};
  const double g[4] = {piece.value, piece.slope, piece.second, piece.third};
  double sum = 0.0;
  for (int n = 7; n >= 0; --n) {
    double factor = 0.0;
    for (int i = std::max(0, n - 4); i <= std::min(3, n); ++i) factor += g[i] * s[n - i];
    sum = sum * t + 2 * factor / (n + 1);
  }
  return sum * t;
}

SphereCurve curve_through(std::span<const CurvePoint> points) {
  SphereCurve out;
  CubicPiece piece{0.0, 1.0, 0.0, 0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double s = std::sqrt(points[i].x), w = s - piece.at, value = points[i].value / (s * s * s),
                 slope = 2 * points[i].slope / (s * s) - 3 * value / s, mean = (value - piece.value) / w;
    if (i == 0) piece.slope = 2 * mean - slope;  // a parabola from g = 1
    piece.second = (3 * mean - 2 * piece.slope - slope) / w;
    piece.third = (piece.slope + slope - 2 * mean) / (w * w);
    out.add(piece);
    piece = {s, value, slope, 0.0, 0.0, piece.integral + phi_integral(piece, w)};
  }
  out.add(piece);
  return out;
}

SphereCurve make_sneddon() {
  constexpr int kPoints = 36;
  constexpr double kDeepest = 3.0;  // s: 9 R
  std::vector<CurvePoint> points;
  for (int i = 1; i <= kPoints; ++i) {
    const double x = std::pow(kDeepest * i / kPoints, 2);
    double low = 0.0, high = x + 1;  // u = artanh(a / R), x = u tanh u
    for (int k = 0; k < 80; ++k) {
      const double u = 0.5 * (low + high);
      (u * std::tanh(u) < x ? low : high) = u;
    }
    const double u = low, a = std::tanh(u);
    points.push_back({x, 0.75 * ((1 + a * a) * u - a), 0.75 * 2 * a});
  }
  return curve_through(points);
}

SphereCurve make_layer(double poisson) {
  constexpr int kPoints = 30;
  constexpr double kLeast = 0.02, kMost = kThin;  // a / h
  std::vector<CurvePoint> points;
  for (int i = 0; i < kPoints; ++i) {
    const double ratio = kLeast * std::pow(kMost / kLeast, i / (kPoints - 1.0));
    const LayerPress press = sphere_on_layer(ratio, poisson);
    points.push_back({press.depth, 0.75 * press.force, 0.75 * 2 * ratio * press.factor});
  }
  return curve_through(points);
}

}  // namespace

SphereCurve::Value SphereCurve::at(double x) const {
  if (!(x > 0.0)) return {0.0, 0.0, 0.0};
  const double last = piece[count - 1].at, s = std::min(std::sqrt(x), last);
  const CubicPiece& p = piece[std::max(begun(s), 1u) - 1];
  const double t = s - p.at, g = p.value + t * (p.slope + t * (p.second + t * p.third)),
               rises = p.slope + t * (2 * p.second + 3 * t * p.third);
  Value out{s * s * s * g, 0.5 * s * (3 * g + s * rises), p.integral + phi_integral(p, t)};
  const double beyond = x - s * s;
  if (s < last || !(beyond > 0.0)) return out;
  out.integral += beyond * (out.value + 0.5 * beyond * out.slope);
  out.value += beyond * out.slope;
  return out;
}

const SphereCurve& sneddon_sphere() {
  static const SphereCurve curve = make_sneddon();
  return curve;
}

const SphereCurve& layer_sphere(double poisson) {
  thread_local double of = -1.0;
  thread_local SphereCurve curve;
  if (of != poisson) curve = make_layer(poisson);
  of = poisson;
  return curve;
}

}  // namespace pliant
