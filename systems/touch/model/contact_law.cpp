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
    sum += (i < broken ? layers[i].remains : 1.0) * (layers[i].stiffness / unlayered) * (this->*own)(depth - top);
  return depth > top ? sum + (this->*own)(depth - top) : sum;
}

double ContactLaw::force(double depth) const {
  return over_layers(depth, &ContactLaw::own_force);
}

double ContactLaw::slope(double depth) const {
  return (1 + arm) * over_layers(depth, &ContactLaw::own_slope);
}

double ContactLaw::potential(double depth) const {
  return over_layers(depth, &ContactLaw::own_potential);
}

double ContactLaw::layer_force(std::size_t layer, double depth) const {
  for (std::size_t i = 0; i < layer; ++i) depth -= layers[i].thickness;
  return depth > 0 ? layers[layer].stiffness / unlayered * own_force(depth) : 0.0;
}

double ContactLaw::layer_energy(std::size_t layer, double depth) const {
  double top = 0.0;
  for (std::size_t i = 0; i < layer; ++i) top += layers[i].thickness;
  if (!(depth > top)) return 0.0;
  const double y = std::max(0.0, free_depth - top), share = layers[layer].stiffness / unlayered;
  return share * (own_potential(depth - top) - own_potential(y) - own_force(y) * (depth - top - y));
}

double ContactLaw::of_depth(double z) const {
  if (hertz == 0.0) return stiffness * z;
  if (sphere) return hertz * unit * std::sqrt(unit) * sphere->at(z / unit).value;
  return hertz * z * std::sqrt(std::max(0.0, z));
}

double ContactLaw::of_depth_slope(double z) const {
  if (hertz == 0.0) return stiffness;
  if (sphere) return hertz * std::sqrt(unit) * sphere->at(z / unit).slope;
  return 1.5 * hertz * std::sqrt(std::max(0.0, z));
}

double ContactLaw::own_force(double depth) const {
  return of_depth(-law->force(-depth));
}

double ContactLaw::own_slope(double depth) const {
  return of_depth_slope(-law->force(-depth)) * law->slope(-depth);
}

double ContactLaw::own_potential(double depth) const {
  if (hertz == 0.0) return stiffness * law->potential(-depth);
  if (!law->curved() && sphere) return hertz * unit * unit * std::sqrt(unit) * sphere->at(depth / unit).integral;
  if (!law->curved()) return 0.4 * hertz * depth * depth * std::sqrt(std::max(0.0, depth));
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

// The depth at which the law alone has this force [N].
double ContactLaw::depth_of_zero(double pressed) const {
  if (!(pressed > 0.0)) return 0.0;  // of a painted stiffness of 0, too
  if (!law->curved() && hertz == 0.0 && layers.empty()) return pressed / stiffness;
  double low = 0.0, high = std::max({relaxed, free_depth, 1e-9});
  for (int i = 0; i < 60 && force(high) < pressed; ++i) high *= 2;  // a softening law may never have it
  double middle = high;
  for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
    middle = 0.5 * (low + high);
    const double r = force(middle) - pressed;
    if (std::abs(r) <= 1e-14 * pressed) break;
    (r > 0 ? high : low) = middle;
  }
  return middle;
}

StoredEnergy ContactLaw::stored(double depth) const {
  StoredEnergy out;
  if (!(depth > 0)) return out;
  const double offset = std::min(force(free_depth), kMostForce);
  double from = free_depth, held = 0.0;  // depth of zero force; S(q)
  if (arm > 0) {
    held = std::min(of_depth(relaxed), kMostForce);
    from = depth_of_zero((offset + arm * held) / (1 + arm));
  }
  if (depth <= from) return out;
  const Limited at = limited(depth), zero = limited(from);
  const double rise = at.potential - zero.potential;
  out.force = at.force - offset + arm * (at.force - held);
  out.by_arm = rise - held * (depth - from);  // the force at `from` is zero
  out.energy = rise - offset * (depth - from) + arm * out.by_arm;
  out.by_relaxed = -arm * of_depth_slope(relaxed) * (depth - from);
  return out;
}

double plane_modulus(const Deformable& deformable) {
  return deformable.young / (1 - deformable.poisson * deformable.poisson);
}

ContactLaw contact_law(const Deformable& deformable, const Motion& motion, double factor, double radius) {
  ContactLaw out;
  out.law = &motion.law;
  out.stiffness = deformable.stiffness * factor;
  if (deformable.young > 0 && radius > 0) {
    out.hertz = 4.0 / 3.0 * plane_modulus(deformable) * std::sqrt(radius) * factor;
    if (motion.sphere.count > 0) out.sphere = &motion.sphere;
    out.unit = deformable.thickness > 0 ? deformable.thickness * deformable.thickness / radius : radius;
  }
  out.arm = motion.arm_stiffness;
  out.layers = {deformable.layers.begin(), deformable.layers.size()};
  out.unlayered = deformable.stiffness;
  return out;
}

}  // namespace pliant
