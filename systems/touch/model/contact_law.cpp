#include "systems/touch/model/contact_law.h"

#include <algorithm>
#include <cmath>

namespace pliant {

double law_force(const RestoringLaw& law, double stiffness, double depth) {
  return -stiffness * law.force(-depth);
}

double painted(const std::vector<float>& factor, const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric) {
  if (factor.empty()) return 1.0;
  const uvec3 t = mesh.triangles[triangle];
  return barycentric.x * factor[t.x] + barycentric.y * factor[t.y] + barycentric.z * factor[t.z];
}

template <class Own>
double ContactLaw::over_layers(double depth, Own own) const {
  if (layers.empty()) return (this->*own)(depth);
  double sum = 0.0, top = 0.0;
  for (std::size_t i = 0; i < layers.size() && depth > top; top += layers[i++].thickness)
    sum += (i < broken ? layers[i].remains : 1.0) * (layers[i].stiffness / unit) * (this->*own)(depth - top);
  return depth > top ? sum + (this->*own)(depth - top) : sum;
}

double ContactLaw::force(double depth) const {
  return over_layers(depth, &ContactLaw::own_force);
}

double ContactLaw::slope(double depth) const {
  return arm + over_layers(depth, &ContactLaw::own_slope);
}

double ContactLaw::potential(double depth) const {
  return over_layers(depth, &ContactLaw::own_potential);
}

double ContactLaw::layer_force(std::size_t layer, double depth) const {
  for (std::size_t i = 0; i < layer; ++i) depth -= layers[i].thickness;
  return depth > 0 ? layers[layer].stiffness / unit * own_force(depth) : 0.0;
}

double ContactLaw::layer_energy(std::size_t layer, double depth) const {
  double top = 0.0;
  for (std::size_t i = 0; i < layer; ++i) top += layers[i].thickness;
  if (!(depth > top)) return 0.0;
  const double y = std::max(0.0, free_depth - top), share = layers[layer].stiffness / unit;
  return share * (own_potential(depth - top) - own_potential(y) - own_force(y) * (depth - top - y));
}

double ContactLaw::own_force(double depth) const {
  const double z = -law.force(-depth);
  return hertz > 0 ? hertz * z * std::sqrt(std::max(0.0, z)) : stiffness * z;
}

double ContactLaw::own_slope(double depth) const {
  const double z = -law.force(-depth), rises = law.slope(-depth);
  return hertz > 0 ? 1.5 * hertz * std::sqrt(std::max(0.0, z)) * rises : stiffness * rises;
}

double ContactLaw::own_potential(double depth) const {
  if (hertz == 0.0) return stiffness * law.potential(-depth);
  if (!law.curved()) return 0.4 * hertz * depth * depth * std::sqrt(std::max(0.0, depth));
  // Gauss-Legendre in sqrt(depth), which removes the square root at zero: d = s^2, dd = 2 s ds.
  constexpr double kAt[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  constexpr double kWeight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  const double half = 0.5 * std::sqrt(std::max(0.0, depth));
  double sum = 0.0;
  for (int i = 0; i < 4; ++i)
    for (const double side : {-1.0, 1.0}) {
      const double s = half * (1 + side * kAt[i]);
      sum += kWeight[i] * 2 * s * own_force(s * s);
    }
  return half * sum;
}

ContactLaw::Limited ContactLaw::limited(double depth) const {
  const double whole = force(depth);
  if (!(whole > kMostForce) || !std::isfinite(depth)) return {whole, potential(depth)};
  double low = 0.0, high = depth;
  for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (force(middle) <= kMostForce ? low : high) = middle;
  }
  return {kMostForce, potential(low) + kMostForce * (depth - low)};
}

StoredEnergy ContactLaw::stored(double depth) const {
  StoredEnergy out;
  if (!(depth > 0)) return out;
  const double offset = std::min(force(free_depth), kMostForce);
  double from = free_depth;  // depth of zero force
  if (arm > 0) {
    // force(d) + arm (d - q) increases with d: at most zero at 0 (q, y >= 0), at least zero at max(q, y).
    double low = 0.0, high = std::max(relaxed_depth, free_depth);
    for (int i = 0; i < 60 && high - low > 1e-15 * high; ++i) {
      from = !law.curved() && hertz == 0.0 ? (arm * relaxed_depth + offset) / (arm + stiffness) : 0.5 * (low + high);
      const double r = force(from) - offset + arm * (from - relaxed_depth);
      if (std::abs(r) <= 1e-14 * (offset + arm * relaxed_depth)) break;
      (r > 0 ? high : low) = from;
    }
  }
  if (depth <= from) return out;
  const double q = relaxed_depth;
  const Limited at = limited(depth);
  out.force = at.force - offset + arm * (depth - q);
  out.by_arm = 0.5 * ((depth - q) * (depth - q) - (from - q) * (from - q));  // the force at `from` is zero
  out.energy = at.potential - limited(from).potential - offset * (depth - from) + arm * out.by_arm;
  out.by_relaxed = -arm * (depth - from);
  return out;
}

double plane_modulus(const Deformable& deformable) {
  return deformable.young / (1 - deformable.poisson * deformable.poisson);
}

ContactLaw contact_law(const Deformable& deformable, const Motion& motion, double factor, double radius) {
  ContactLaw out;
  out.law = motion.law;
  out.stiffness = deformable.stiffness * factor;
  if (deformable.young > 0 && radius > 0)
    out.hertz = 4.0 / 3.0 * plane_modulus(deformable) * std::sqrt(radius) * factor;
  out.arm = motion.arm_stiffness * out.stiffness;
  out.layers = {deformable.layers.begin(), deformable.layers.size()};
  out.unit = deformable.stiffness;
  return out;
}

}  // namespace pliant
