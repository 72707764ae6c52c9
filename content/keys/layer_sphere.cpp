#include "content/keys/layer_sphere.h"

#include <algorithm>
#include <cmath>

#include "components/bonded_layer.h"

namespace pliant {
namespace {

constexpr int kCircles = 16;  // evenly spaced contact radii; the ratio of d' to Hertz's is constant between them
// Gauss-Legendre rule on [0, 1].
constexpr double kAt[4] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
constexpr double kWeight[4] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};

double hertz(double radius, double depth) {
  return 4.0 / 3.0 * std::sqrt(radius) * depth * std::sqrt(depth);
}

}  // namespace

LayerSphere::LayerSphere(double radius, double thickness, double poisson, double deepest) : radius_(radius) {
  if (!(thickness > 0.0)) return;
  // On a layer d grows more slowly with a than on a half-space, at least half as fast (d = a^2 / 2R for a thin one).
  const double widest = std::sqrt(2 * radius * deepest), step = widest / kCircles;
  std::vector<double> growth;  // [1] d' over 2 a / R, between circles
  double depth = 0.0, force = 0.0;
  depth_.push_back(0.0);
  over_hertz_.push_back(1.0);
  for (int i = 0; i < kCircles; ++i) {
    const double r = (i + 1) * step;
    double known = 0.0, last = 0.0;  // parts of r^2 / 2R: of the previous circles, and of this one per unit growth
    for (int j = 0; j <= i; ++j)
      for (int q = 0; q < 4; ++q) {
        // u has a square-root slope at the punch's edge: substitute squares towards r.
        const double s = kAt[q], from = (i - j + 1) * step, to = (i - j) * step;
        const double near = std::sqrt(to) + s * (std::sqrt(from) - std::sqrt(to)), a = r - near * near;
        const double length = kWeight[q] * 2 * near * (std::sqrt(from) - std::sqrt(to));
        const double part = length * (1 - BondedLayer(a / thickness, poisson).surface(r / a)) * 2 * a / radius;
        (j == i ? last : known) += part * (j == i ? 1.0 : growth[static_cast<std::size_t>(j)]);
      }
    growth.push_back((r * r / (2 * radius) - known) / last);
    for (int q = 0; q < 4; ++q) {
      const double a = (i + kAt[q]) * step, more = kWeight[q] * step * 2 * a / radius * growth.back();
      depth += more;
      force += 2 * a * bonded_layer_factor(a / thickness, poisson) * more;
    }
    depth_.push_back(depth);
    over_hertz_.push_back(force / hertz(radius, depth));
  }
}

double LayerSphere::force(double depth) const {
  if (!(depth > 0.0)) return 0.0;
  if (depth_.empty()) return hertz(radius_, depth);
  const auto above = std::min<std::size_t>(
      depth_.size() - 1,
      static_cast<std::size_t>(std::upper_bound(depth_.begin() + 1, depth_.end(), depth) - depth_.begin()));
  // The table has even steps of the contact radius: interpolate in the square root of the depth.
  const double low = std::sqrt(depth_[above - 1]), high = std::sqrt(depth_[above]);
  const double share = (std::sqrt(depth) - low) / (high - low);
  return hertz(radius_, depth) * (over_hertz_[above - 1] + share * (over_hertz_[above] - over_hertz_[above - 1]));
}

}  // namespace pliant
