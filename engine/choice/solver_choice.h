// Error and cost of each solver on a body's system.
#pragma once

#include <vector>

#include "engine/choice/body_press.h"

namespace pliant {

struct SolverFigures {
  SolverKind kind = SolverKind::kAuto;
  double error = 0.0;     // [1] of the velocities of a step, relative to a fully refined direct solution
  double more_ms = 0.0;   // [ms] per step, in addition to `auto`: counted
  double measured = 0.0;  // [ms] on this machine: factorise and solve once
};

// The selectable solvers: `auto` and those of this build, except the dense one, which is for tests.
std::vector<SolverKind> solvers_to_choose();
// Measures a step of T [s] under `load` [N] from rest. Solvers that fail are left out.
std::vector<SolverFigures> measure_solvers(const TetMesh& tets, const TissueMaterial& material,
                                           const std::vector<dvec3>& load, double T,
                                           const std::vector<SolverKind>& kinds);

}  // namespace pliant
