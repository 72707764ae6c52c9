#include "systems/soft/fem/passive_step.h"

#include <numeric>

namespace pliant {
namespace {

constexpr int kMostShorter = 20;       // 1e-6 of the motion
constexpr double kEnergySlack = 1e-9;  // [1] of the energies: rounding
constexpr double kRounding = 1e-14;    // [1] of Young's modulus times the volume: of the elastic energy at rest

dvec3 at(const Vector& v, std::size_t node) {
  const Eigen::Index i = 3 * static_cast<Eigen::Index>(node);
  return {v[i], v[i + 1], v[i + 2]};
}

}  // namespace

double energy_rounding(const Tissue& tissue) {
  const TissueMaterial& its = tissue.material();
  const double mass = std::accumulate(tissue.mass().begin(), tissue.mass().end(), 0.0);
  return kRounding * its.young / (1 - 2 * its.poisson) * mass / its.density;
}

double passive_share(const Tissue& tissue, const std::vector<dvec3>& carried, const Vector& d, std::uint32_t weighed,
                     double T) {
  const std::uint32_t moving = tissue.moving();
  const auto place = [&](double s) {
    std::vector<dvec3> x = tissue.position();
    for (std::uint32_t i = 0; i < x.size(); ++i) x[i] += T * (carried[i] + (i < moving ? s * at(d, i) : dvec3(0)));
    return x;
  };
  Vector Ad(d.size());
  tissue.multiply(d, Ad);
  double dMd = 0.0, dMd0 = 0.0, d0Md0 = 0.0, elastic = d.dot(Ad);
  for (std::uint32_t i = 0; i < moving; ++i) {
    const dvec3 now = at(d, i), before = tissue.velocity()[i] - carried[i];
    const double m = tissue.mass()[i];
    dMd += m * dot(now, now), dMd0 += m * dot(now, before), d0Md0 += m * dot(before, before);
    if (i < weighed) elastic -= m * (1.0 + T * tissue.material().alpha) * dot(now, now);
  }
  const double work = T * d.dot(tissue.elastic_force().head(d.size()));
  const double rest = tissue.elastic_energy(place(0.0)),
               slack = kEnergySlack * (rest + dMd + d0Md0) + energy_rounding(tissue);
  double s = 1.0;
  for (int i = 0; i < kMostShorter; ++i, s *= 0.5) {
    const double gain = tissue.elastic_energy(place(s)) - rest + s * work - s * elastic;
    if (gain <= 0.5 * (d0Md0 - 2.0 * s * dMd0 + s * s * dMd) + s * (1.0 - s) * dMd + slack) break;
  }
  return s;
}

}  // namespace pliant
