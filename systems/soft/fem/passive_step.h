// Guards a step of tissue with a law for large strain. The step is linearised where it begins, which holds for any load
// that changes little in a step. Where stiffness changes much (inverted or flattened elements spring back), it could
// overshoot and gain energy without bound. Newton's iterations of the step alone would not do: tissue is linearised
// with its contacts, and without them it moves to somewhere else.
#pragma once

#include "systems/soft/fem/tissue.h"

namespace pliant {

// The largest of 1, 1/2, 1/4 ... by which the step's motion relative to `carried` [m/s per node] is multiplied, in
// velocity and in way, so that it does not gain energy. `tissue` as at the beginning of the step of T [s], with its
// matrix and forces; d: of its moving nodes, the solution less `carried`. With d0 the velocity at the beginning less
// `carried`, and A d of the step's matrix A, the gain of energy beside the work of loads is at most zero if
//   E(s) - E(0) + s T f.d - s d.(A - M)d <= |d0 - s d|^2/2 + s (1 - s) |d|^2,   norms by M.
// `weighed`: leading nodes whose mass is in A.
double passive_share(const Tissue& tissue, const std::vector<dvec3>& carried, const Vector& d, std::uint32_t weighed,
                     double T);

// [J] By which elastic_energy() of tissue at rest may be wrong.
double energy_rounding(const Tissue& tissue);

}  // namespace pliant
