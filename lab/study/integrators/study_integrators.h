// Time steps of one vertex: cost against error, and the region of stability. Every scheme (integrators.h) integrates
// every spring law from a dent of 20 mm at rest, over 0.1 s (at least 8 steps).
#pragma once

#include <vector>

#include "lab/console/interrupt.h"
#include "lab/console/progress.h"
#include "lab/study/integrators/integrators.h"
#include "lab/study/pareto.h"
#include "scenes/touch_laws.h"

namespace pliant {

inline constexpr double kDent = -0.02;      // [m]
inline constexpr double kIntegrated = 0.1;  // [s]
const char* name_of(SpringLaw law);

struct IntegratorCase {
  SpringLaw law = SpringLaw::kLinear;
  Integrator integrator = Integrator::kExact;
  double k = 1.0, zeta = 1.0, dt = 1e-3;  // [N/m] [1] [s]
  double error = 0.0;                     // [1] RMS over the steps, relative to the dent; infinite: unstable
};

// Criterion of stability here and in the maps, over 2,000 steps and at least four natural periods: no height exceeds a
// thousand dents, and the second half of the oscillation is no larger than the first.
inline constexpr int kStableSteps = 2000;
inline constexpr double kStablePeriods = 4.0;
bool is_stable(Integrator integrator, const VertexProblem& problem, double dt);

// [1] RMS over the steps, relative to the dent. `truth`: true_heights() at intervals of `every` [s]; dt is a multiple
// of it.
double integration_error(Integrator integrator, const VertexProblem& problem, double dt, double every,
                         const std::vector<double>& truth);
std::vector<IntegratorCase> integrate_grid(const std::vector<double>& stiffness, const std::vector<double>& zetas,
                                           const std::vector<double>& steps, const Interrupt* interrupt = nullptr,
                                           Progress* progress = nullptr);

// At steps of 1 ms, with the stiffness from natural frequency times step.
VertexProblem problem_at(SpringLaw law, double omega_T, double zeta);

// [ns] per vertex and step: median over k and damping ratio, each the minimum over that many batches of 50 steps of a
// zone.
double vertex_step_ns(Integrator integrator, SpringLaw law, const std::vector<double>& stiffness,
                      const std::vector<double>& zetas, double dt, int batches);

// Without costs. One row per scheme and step length: median over k and damping ratio.
ParetoTable integrator_table(const std::vector<IntegratorCase>& cases, SpringLaw law);

}  // namespace pliant
