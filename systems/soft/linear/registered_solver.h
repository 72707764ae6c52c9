// A registered solver (pliant/linear_solver.h) behind the interface of the built-in ones.
#pragma once

#include "pliant/linear_solver.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {

// Null if the factory returns nothing.
std::unique_ptr<LinearSolver> make_registered(const SolverFactory& factory);

}  // namespace pliant
