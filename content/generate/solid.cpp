#include "content/generate/solid.h"

#include <algorithm>
#include <cmath>

namespace pliant::generate {
namespace {

// Approximate distance to an ellipsoid: exact to first order at its surface.
double ellipsoid(dvec3 p, dvec3 center, dvec3 radii) {
  const dvec3 q = (p - center) / radii;
  const double k = length(q);
  return k < 1e-9 ? -std::min({radii.x, radii.y, radii.z}) : k * (k - 1.0) / length(q / radii);
}

}  // namespace

double groove(dvec3 p) {
  const double middle = 0.024 + 0.12 * p.y + 1.5 * p.y * p.y;  // [m] the centre line of the groove down the front
  const double across = (p.x - middle) / 0.0085;
  const double front = 1.0 / (1.0 + std::exp(-(p.z - 0.004) / 0.006));
  return std::exp(-across * across) * front;
}

Solid organ() {
  return [](dvec3 p) {
    constexpr double kBlend = 0.011;    // [m] blend radius between lobes
    constexpr double kGroove = 0.0085;  // [m] depth
    const double lobes[] = {ellipsoid(p, {-0.036, 0.004, 0.0}, {0.070, 0.050, 0.046}),
                            ellipsoid(p, {0.056, 0.012, 0.004}, {0.054, 0.033, 0.032}),
                            ellipsoid(p, {-0.052, -0.040, 0.006}, {0.038, 0.032, 0.034}),
                            ellipsoid(p, {0.010, -0.030, 0.018}, {0.030, 0.022, 0.022})};
    double sum = 0.0;
    for (const double d : lobes) sum += std::exp(-d / kBlend);
    return -kBlend * std::log(sum) + kGroove * groove(p);
  };
}

Solid pad() {
  return [](dvec3 p) {
    const dvec3 half(0.080, 0.020, 0.050);
    const double top = glm::smoothstep(-half.y, half.y, p.y);
    const double sinks = 0.006 * top * (p.x * p.x / (half.x * half.x) + p.z * p.z / (half.z * half.z));  // [m] outward
    const dvec3 q = dvec3(p.x, p.y + sinks, p.z) / half;
    const dvec3 q2 = q * q;
    const double k = std::sqrt(std::sqrt(dot(q2 * q2, q2 * q2)));  // |q|_8^2, a box with rounded edges
    return 0.5 * (k - 1.0) * half.y;
  };
}

Solid heart() {
  return [](dvec3 p) {
    constexpr double kBlend = 0.014;  // [m] blend radius between the parts
    const double parts[] = {ellipsoid(p, {-0.036, 0.024, 0.0}, {0.042, 0.042, 0.036}),
                            ellipsoid(p, {0.036, 0.024, 0.0}, {0.042, 0.042, 0.036}),
                            ellipsoid(p, {0.0, -0.012, 0.0}, {0.046, 0.040, 0.036}),
                            ellipsoid(p, {0.0, -0.046, 0.0}, {0.018, 0.026, 0.018})};
    double sum = 0.0;
    for (const double d : parts) sum += std::exp(-d / kBlend);
    return -kBlend * std::log(sum);
  };
}

Solid cushion() {
  return [](dvec3 p) {
    const dvec3 half(0.100, 0.035, 0.100), q = p / half;
    const double flat = std::sqrt(q.x * q.x * q.x * q.x + q.z * q.z * q.z * q.z);  // round corners
    return 0.5 * (flat + q.y * q.y - 1.0) * half.y;
  };
}

Solid ridged_ball() {
  return [](dvec3 p) {
    const double r = length(p);
    if (r == 0.0) return -0.05;
    // s^6 cos(6 phi) is a polynomial of the direction: smooth at the poles too.
    const double s = std::hypot(p.x, p.z) / r, phi = std::atan2(p.x, p.z);
    return r - 0.0485 - 0.0015 * std::pow(s, 6.0) * std::cos(6.0 * phi);
  };
}

}  // namespace pliant::generate
