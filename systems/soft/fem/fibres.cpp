#include "systems/soft/fem/fibres.h"

#include <cmath>
#include <numbers>

namespace pliant {

double rest_length(const Fibres& fibres, double time) {
  if (!(fibres.period > 0.0)) return 1.0 - fibres.contraction;
  return 1.0 - 0.5 * fibres.contraction * (1.0 - std::cos(2.0 * std::numbers::pi * time / fibres.period));
}

FibrePull pull_of(const FibreStep& fibres, const ElementPack& pack, std::size_t lane, const ElementVisit& visit) {
  FibrePull out;
  dvec3 t(0);  // F a
  out.share[0] = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    double share = 0.0;
    for (int d = 0; d < 3; ++d) share += pack.gradient[k][d][lane] * fibres.along[d];
    out.share[k + 1] = share;
    out.share[0] -= share;
    t += share * dvec3(visit.edge[k][0][lane], visit.edge[k][1][lane], visit.edge[k][2][lane]);
  }
  const double s = length(t), longer = s - fibres.rest, stiffness = pack.volume[lane] * fibres.young;
  if (!(s > 0.0) || (fibres.only_tension && longer < 0.0)) return out;
  const dvec3 n = t / s;
  const dmat3 along = outerProduct(n, n);
  out.pull = stiffness * longer * n;
  out.slope = stiffness * (along + std::fmax(0.0, longer / s) * (dmat3(1.0) - along));
  out.energy = 0.5 * stiffness * longer * longer;
  return out;
}

}  // namespace pliant
