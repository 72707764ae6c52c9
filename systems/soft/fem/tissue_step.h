// Tissue by itself, one step at a time: for tests, studies and benchmarks. Bodies in a level step through body.h.
// Nodes outside tissue.moving() go where their velocity() takes them.
#pragma once

#include "systems/soft/fem/tissue.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {

enum class Scheme : std::uint8_t {
  kEuler,     // implicit: damps, of order 1
  kMidpoint,  // implicit: of order 2; iterated to the end it keeps momenta exactly and energy while forces are linear
};

struct TissueStep {
  Scheme scheme = Scheme::kEuler;
  int iterations = 1;                        // at most this many assemblies; 1: linearised where the step begins
  double tolerance = 0.0;                    // [1] stop when the velocity changes by less than this part of itself
  const std::vector<dvec3>* push = nullptr;  // [N] on each node, besides gravity
};

struct TissueReport {
  int iterations = 0;
  double change = 0.0;  // [1] of the velocity in the last iteration, in its own size
  bool solved = true;   // false: A was not positive definite; nothing has moved
};

// One step of T [s] under gravity [m/s2]. `solver` has analysed tissue.inner().
TissueReport step_tissue(Tissue& tissue, LinearSolver& solver, double T, dvec3 gravity, const TissueStep& step = {});

// The resting place from here on, nodes outside tissue.moving() held: one step so long that inertia is nothing,
// iterated (step.scheme does not matter). Something must hold the tissue. Velocities are zero afterwards.
TissueReport settle_tissue(Tissue& tissue, LinearSolver& solver, dvec3 gravity, TissueStep step);

double kinetic_energy(const Tissue& tissue);  // [J]

}  // namespace pliant
