// Steps tissue alone: for tests, studies and benchmarks. Bodies in a level step through body.h. Nodes outside
// tissue.moving() move with their velocity().
#pragma once

#include "systems/soft/fem/tissue.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {

enum class Scheme : std::uint8_t {
  kEuler,     // implicit: dissipative, first order
  kMidpoint,  // implicit: second order; iterated to convergence it conserves momenta, and energy for linear forces
};

struct TissueStep {
  Scheme scheme = Scheme::kEuler;
  int iterations = 1;                        // largest number of assemblies; 1: linearised at the beginning of the step
  double tolerance = 0.0;                    // [1] stop when the relative change of the velocity is smaller
  const std::vector<dvec3>* push = nullptr;  // [N] on each node, besides gravity
};

struct TissueReport {
  int iterations = 0;
  double change = 0.0;  // [1] relative change of the velocity in the last iteration
  bool solved = true;   // false: A was not positive definite; nothing has moved
};

// One step of T [s] under gravity [m/s2]. `solver` has analysed tissue.inner().
TissueReport step_tissue(Tissue& tissue, LinearSolver& solver, double T, dvec3 gravity, const TissueStep& step = {});

// The equilibrium from the current state, nodes outside tissue.moving() fixed: one step so long that inertia is
// negligible, iterated (step.scheme has no effect). The tissue must be constrained. Velocities are zero afterwards.
TissueReport settle_tissue(Tissue& tissue, LinearSolver& solver, dvec3 gravity, TissueStep step);

double kinetic_energy(const Tissue& tissue);  // [J]

}  // namespace pliant
