// The alternating direction method of multipliers on a contact problem, for islands that sweeps and Newton steps leave
// unsettled: walls and heaps, where loads can be shared in many ways. Impulses that move bodies freely, x, and impulses
// inside the friction cones, z, are found in turn and drawn together; Coulomb's law takes the sliding speed as a shift
// of the normal velocity (De Saxce), as Tasora, Mangoni, Benatti & Garziera (International Journal for Numerical
// Methods in Engineering 122, 2021) do. Steps are over-relaxed and rho is balanced (Boyd et al., Foundations and Trends
// in Machine Learning 3, 2011, 3.4). For the soft clock: it allocates.
#pragma once

#include "systems/soft/contact/contact_sweeps.h"

namespace pliant {

struct AdmmLimits {
  int iterations = 0;
  double work = 0.0;  // [1] multiplications of a factor, about: more, and nothing is done
};

// From impulses and velocities with `residual` [m/s] to better ones, or back to the same ones. Returns their residual;
// below `enough`, it need not fall further. `iterations`: done.
double improve_by_admm(ContactSweeps& sweeps, double residual, double enough, const AdmmLimits& limits,
                       int& iterations);

}  // namespace pliant
