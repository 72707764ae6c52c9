#include "systems/visual/coat.h"

#include <algorithm>
#include <cmath>

namespace pliant {

vec2 coat_reflectance(double n_v, double roughness, int samples) {
  const double alpha = std::max(roughness * roughness, 1e-4), a2 = alpha * alpha;
  const dvec3 v(std::sqrt(std::max(0.0, 1 - n_v * n_v)), 0, n_v);
  double A = 0, B = 0;
  for (int i = 0; i < samples; ++i) {
    // A lattice over the square, mapped to half vectors distributed as D(h) (n.h).
    const double x = (i + 0.5) / samples, turn = 2 * M_PI * std::fmod(0.61803398875 * i, 1.0);
    const double cos_h = std::sqrt((1 - x) / (1 + (a2 - 1) * x)), sin_h = std::sqrt(std::max(0.0, 1 - cos_h * cos_h));
    const dvec3 h(sin_h * std::cos(turn), sin_h * std::sin(turn), cos_h);
    const double v_h = dot(v, h), n_l = 2 * v_h * h.z - v.z;
    if (n_l <= 0 || v_h <= 0) continue;
    const double shadow_v = n_l * std::sqrt(n_v * n_v * (1 - a2) + a2),
                 shadow_l = n_v * std::sqrt(n_l * n_l * (1 - a2) + a2);
    const double visibility = 0.5 / (shadow_v + shadow_l);
    const double weight = visibility * 4 * v_h * n_l / cos_h, f = std::pow(1 - v_h, 5.0);
    A += (1 - f) * weight;
    B += f * weight;
  }
  return vec2(dvec2(A, B) / static_cast<double>(samples));
}

std::vector<vec2> coat_table(int size) {
  constexpr int kSamples = 512;
  std::vector<vec2> table;
  table.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column)
      table.push_back(coat_reflectance((column + 0.5) / size, (row + 0.5) / size, kSamples));
  return table;
}

}  // namespace pliant
