#include "systems/soft/fem/flesh_step.h"

#include <algorithm>

namespace pliant {
namespace {

constexpr double kForever = 1e6;  // [s] against periods of less than a second: inertia is 1e-12 of stiffness

dvec3 node_of(const Vector& v, std::size_t node) {
  const Eigen::Index i = 3 * static_cast<Eigen::Index>(node);
  return {v[i], v[i + 1], v[i + 2]};
}

// What the system has on the right: handle nodes without rows are told where to go, so their terms move over.
Vector right_side(const Flesh& flesh, double h, const std::vector<dvec3>* push) {
  Vector right = flesh.right().head(3 * flesh.moving());
  for (const Flesh::Entry& entry : flesh.outer()) {
    const dvec3 v = flesh.velocity()[entry.column];
    right.segment<3>(3 * entry.row) -= entry.value * Eigen::Vector3d(v.x, v.y, v.z);
  }
  if (push)
    for (std::uint32_t i = 0; i < flesh.moving(); ++i)
      right.segment<3>(3 * i) += h * Eigen::Vector3d((*push)[i].x, (*push)[i].y, (*push)[i].z);
  return right;
}

}  // namespace

FleshReport step_flesh(Flesh& flesh, LinearSolver& solver, double T, dvec3 gravity, const FleshStep& step) {
  // The midpoint rule is an implicit Euler step of half the length and the same again without asking.
  const bool midpoint = step.scheme == Scheme::kMidpoint;
  const double h = midpoint ? T / 2 : T;
  const std::vector<dvec3> begin = flesh.position();
  std::vector<dvec3>& x = flesh.position();
  std::vector<dvec3>& v = flesh.velocity();
  Vector now = Vector::Zero(3 * flesh.moving()), last = now;
  FleshReport report;
  while (report.iterations < step.iterations) {
    flesh.assemble(h, gravity, report.iterations > 0 ? &begin : nullptr);
    solver.place(flesh.position());
    report.solved = solver.factorise(flesh.inner());
    if (!report.solved) {
      x = begin;
      return report;
    }
    last = now;
    solver.solve(right_side(flesh, h, step.push), now);
    ++report.iterations;
    const double size = now.norm();
    report.change = size > 0 ? (now - last).norm() / size : 0.0;
    if (report.change <= step.tolerance) break;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = begin[i] + h * (i < flesh.moving() ? node_of(now, i) : v[i]);
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const dvec3 mean = i < flesh.moving() ? node_of(now, i) : v[i];
    x[i] = begin[i] + T * mean;
    v[i] = midpoint && i < flesh.moving() ? 2.0 * mean - v[i] : mean;
  }
  return report;
}

FleshReport settle_flesh(Flesh& flesh, LinearSolver& solver, dvec3 gravity, FleshStep step) {
  step.scheme = Scheme::kEuler;
  std::fill(flesh.velocity().begin(), flesh.velocity().end(), dvec3(0));
  const FleshReport report = step_flesh(flesh, solver, kForever, gravity, step);
  std::fill(flesh.velocity().begin(), flesh.velocity().end(), dvec3(0));
  return report;
}

double kinetic_energy(const Flesh& flesh) {
  double energy = 0.0;
  for (std::size_t i = 0; i < flesh.mass().size(); ++i)
    energy += 0.5 * flesh.mass()[i] * dot(flesh.velocity()[i], flesh.velocity()[i]);
  return energy;
}

}  // namespace pliant
