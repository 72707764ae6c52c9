// Errors of a model's press, and the law that fits one best.
#include <cmath>

#include "lab/study/fidelity/study_fidelity.h"

namespace pliant {
namespace {

constexpr double kFieldAround = 5.0;  // [1] radii within which surfaces are compared

// The shape of a law's force over the depth d [m]: F = k g(d). `shape`: k3 / k, or alpha.
double law_shape(SpringLaw law, double shape, double d) {
  switch (law) {
    case SpringLaw::kCubic:
      return d + shape * d * d * d;
    case SpringLaw::kExponential:
      return std::expm1(shape * d) / shape;
    default:
      return d;
  }
}

}  // namespace

double law_force(const DeformableParameters& law, double d) {
  const double shape = law.spring == SpringLaw::kCubic ? law.cubic / law.stiffness : law.stiffening;
  return law.stiffness * law_shape(law.spring, shape, d);
}

double force_error(const Indentation& model, const Indentation& truth) {
  double off = 0.0, size = 0.0;
  for (std::size_t i = 0; i < truth.force.size(); ++i) {
    off += (model.force[i] - truth.force[i]) * (model.force[i] - truth.force[i]);
    size += truth.force[i] * truth.force[i];
  }
  return std::sqrt(off / size);
}

double surface_error(const Indentation& model, const PressTruth& truth) {
  double off = 0.0, size = 0.0;
  for (const auto& [r, share] : model.surface) {
    if (r > kFieldAround * truth.inner) continue;
    const double u = truth.share(r);
    off += (share - u) * (share - u);
    size += u * u;
  }
  return std::sqrt(off / size);
}

DeformableParameters fitted_law(DeformableParameters law, const std::vector<double>& depths,
                                const std::vector<double>& force) {
  // The force is linear in k: F = k g(d). The shape of g, k3/k or alpha, is searched in a list; k follows by least
  // squares.
  const double unit = 1 / depths.back();
  double least_row = 1e300;
  for (int i = 0; i <= 121; ++i) {
    // [1] times the deepest depth; only the exponential law may be negative (softening).
    const double stiffening = (i % 2 ? -1 : 1) * 1e-3 * std::pow(10.0, i / 2 / 15.0);
    if (stiffening < 0 && law.spring != SpringLaw::kExponential) continue;
    const double shape = law.spring == SpringLaw::kCubic ? stiffening * unit * unit : stiffening * unit;
    double up = 0.0, down = 0.0, off = 0.0;
    for (std::size_t k = 0; k < depths.size(); ++k) {
      const double x = law_shape(law.spring, shape, depths[k]);
      up += x * force[k], down += x * x;
    }
    for (std::size_t k = 0; k < depths.size(); ++k) {
      const double e = up / down * law_shape(law.spring, shape, depths[k]) - force[k];
      off += e * e;
    }
    if (!(off < least_row)) continue;
    least_row = off;
    law.stiffness = up / down;
    if (law.spring == SpringLaw::kCubic) law.cubic = shape * law.stiffness;
    if (law.spring == SpringLaw::kExponential) law.stiffening = shape;
    if (law.spring == SpringLaw::kLinear) break;
  }
  return law;
}

}  // namespace pliant
