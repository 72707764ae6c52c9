// The alternating direction method of multipliers on a contact problem, for islands on which sweeps and Newton steps do
// not converge. These are walls and heaps, where loads can be shared in many ways. It alternates between unconstrained
// impulses x and impulses z inside the friction cones, and draws them together. Coulomb's law enters as a shift of the
// normal velocity by the sliding speed (De Saxce), as in Tasora, Mangoni, Benatti & Garziera (International Journal for
// Numerical Methods in Engineering 122, 2021). Steps are over-relaxed and rho is balanced (Boyd et al., Foundations and
// Trends in Machine Learning 3, 2011, 3.4). For the soft clock: it allocates.
#pragma once

#include "systems/soft/contact/contact_sweeps.h"

namespace pliant {

struct AdmmLimits {
  int iterations = 0;
  double work = 0.0;  // [1] limit of a factorisation's multiplications, approximately; above it, nothing is done
};

// Improves impulses and velocities with `residual` [m/s], or restores them. Returns their residual; it stops below
// `enough`. `iterations`: number done.
double improve_by_admm(ContactSweeps& sweeps, double residual, double enough, const AdmmLimits& limits,
                       int& iterations);

}  // namespace pliant
