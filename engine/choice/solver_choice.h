// What each solver makes of a body's own system: its error on it, and what it costs.
#pragma once

#include <vector>

#include "engine/choice/body_press.h"

namespace pliant {

struct SolverFigures {
  SolverKind kind = SolverKind::kAuto;
  double error = 0.0;     // [1] of the velocities of a step, to a direct solution refined to its last digits
  double more_ms = 0.0;   // [ms] a step, beyond what `auto` takes: counted
  double measured = 0.0;  // [ms] of this machine: factorise and solve once
};

// The solvers that may be chosen: `auto` and those of this build, without the dense one, which is for tests.
std::vector<SolverKind> solvers_to_choose();
// Of a step of T [s] under `load` [N] from rest. Kinds that fail are left out.
std::vector<SolverFigures> measure_solvers(const TetMesh& tets, const TissueMaterial& material,
                                           const std::vector<dvec3>& load, double T,
                                           const std::vector<SolverKind>& kinds);

}  // namespace pliant
