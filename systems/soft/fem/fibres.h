// Fibres in a tetrahedron, along the unit vector a of its rest shape (transversely isotropic tissue): with the
// deformation gradient F, s = |F a|, n = F a / s and their rest length l, the energy V E (s - l)^2 / 2 gives
//   f_i = -V E (s - l) (a . b_i) n,   K_ij = V (a . b_i)(a . b_j) E (n n^T + (1 - l / s)(1 - n n^T)),
// whose second part, below zero where fibres are compressed, is left out there. l = 1 - contraction.
#pragma once

#include "pliant/parameters.h"
#include "systems/soft/fem/element.h"

namespace pliant {

struct FibreStep {
  double young = 0.0;         // [Pa]
  dvec3 along{1, 0, 0};       // [1] a
  double rest = 1.0;          // [1] l
  bool only_tension = false;  // no force where s < l
};

// l of fibres after a time [s].
double rest_length(const Fibres& fibres, double time);

struct FibrePull {
  std::array<double, 4> share;  // [1/m] a . b_i
  dvec3 pull{0};                // [N m] V E (s - l) n: f_i = -share_i pull
  dmat3 slope{0.0};             // [N m] K_ij = share_i share_j slope
  double energy = 0.0;          // [J]
};
// From the edges.
FibrePull pull_of(const FibreStep& fibres, const ElementPack& pack, std::size_t lane, const ElementVisit& visit);

}  // namespace pliant
