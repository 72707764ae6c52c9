#include "engine/choice/solver_choice.h"

#include <algorithm>
#include <cmath>

#include "components/registered.h"
#include "runtime/clock.h"
#include "systems/soft/linear/block_cholesky.h"
#include "systems/soft/linear/conjugate_gradient.h"

namespace pliant {
namespace {

// Cost model from measurements (systems/soft/linear/auto_solver.h, bench/results/README.md): a factorisation, a
// right-hand side solved with it, and an iteration of conjugate gradients. step_cost.h assumes a tool with some 60
// contacts: three right-hand sides each, and one for the step.
constexpr double kColumns = 181.0;
constexpr double kFlopNs = 0.08, kFrontNs = 1000.0;       // [ns] of a factorisation, per node
constexpr double kSolveNs = 0.75;                         // [ns] of a right-hand side, flops^(2/3)
constexpr double kSetupNs = 500.0, kIterationNs = 100.0;  // [ns] per node
constexpr double kDenseFlopNs = 0.07;

struct SystemSize {
  double nodes, flops;  // flops: of a block-cholesky factorisation
  double iterations;    // of conjugate gradients on this system
};

double direct_ms(const SystemSize& s, double factor, double column) {
  return 1e-6 * (factor * (kFlopNs * s.flops + kFrontNs * s.nodes) +
                 column * kColumns * kSolveNs * std::pow(s.flops, 2.0 / 3.0));
}

double iterative_ms(const SystemSize& s) {
  return 1e-6 * s.nodes * (kSetupNs + kColumns * s.iterations * kIterationNs);
}

double cost_ms(SolverKind kind, const SystemSize& s) {
  const SolverRow& row = row_of(kind);
  const double n = 3 * s.nodes;
  switch (row.cost) {
    case SolverCost::kDirect:
      return direct_ms(s, row.factorisation, row.column);
    case SolverCost::kIterative:
      return iterative_ms(s);
    case SolverCost::kDense:
      return 1e-6 * kDenseFlopNs * (n * n * n / 3 + 2 * kColumns * n * n);
    case SolverCost::kBest:
      break;
  }
  return std::min(direct_ms(s, 1, 1), iterative_ms(s));
}

}  // namespace

std::vector<SolverKind> solvers_to_choose() {
  std::vector<SolverKind> kinds = available_solvers();
  std::erase(kinds, SolverKind::kDense);
  kinds.insert(kinds.begin(), SolverKind::kAuto);
  return kinds;
}

std::vector<SolverFigures> measure_solvers(const TetMesh& tets, const TissueMaterial& material,
                                           const std::vector<dvec3>& load, double T,
                                           const std::vector<SolverKind>& kinds) {
  Tissue tissue(tets, material, tets.free_count);
  tissue.assemble(T, dvec3(0));
  const BlockMatrix& a = tissue.inner();
  const auto numbers = 3 * static_cast<Eigen::Index>(tissue.moving());
  Vector right = Vector::Zero(numbers), truth = right, residual = right, more = right;
  for (std::uint32_t i = 0; i < tissue.moving(); ++i)
    right.segment<3>(3 * i) = T * Eigen::Vector3d(load[i].x, load[i].y, load[i].z);
  BlockCholesky direct;
  direct.analyse(a);
  if (!direct.factorise(a)) return {};
  direct.solve(right, truth);
  for (int i = 0; i < 3; ++i) {
    a.multiply(truth, residual);
    residual = right - residual;
    direct.solve(residual, more);
    truth += more;
  }
  ConjugateGradient iterative;
  iterative.analyse(a);
  iterative.place(tets.nodes);
  SystemSize size{static_cast<double>(a.size), direct.flops(), static_cast<double>(ConjugateGradient::kMostIterations)};
  if (iterative.factorise(a)) {
    Vector x = Vector::Zero(right.size());
    iterative.solve(right, x);
    size.iterations = iterative.iterations();
  }

  std::vector<SolverFigures> out;
  for (const SolverKind kind : kinds) {
    const auto solver = make_solver(kind, a.size);
    if (!solver) continue;
    solver->analyse(a);
    solver->place(tets.nodes);
    const std::uint64_t begin = now_ns();
    if (!solver->factorise(a)) continue;
    Vector x = Vector::Zero(right.size());
    solver->solve(right, x);
    const double ms = static_cast<double>(now_ns() - begin) * 1e-6;
    const double error = (x - truth).norm() / truth.norm();
    if (!std::isfinite(error)) continue;
    out.push_back({kind, error, cost_ms(kind, size) - cost_ms(SolverKind::kAuto, size), ms});
  }
  return out;
}

}  // namespace pliant
