#include "systems/soft/fem/tissue_step.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/fem/passive_step.h"

namespace pliant {
namespace {

constexpr double kForever = 1e6;  // [s] against periods of less than a second: inertia is 1e-12 of stiffness

dvec3 node_of(const Vector& v, std::size_t node) {
  const Eigen::Index i = 3 * static_cast<Eigen::Index>(node);
  return {v[i], v[i + 1], v[i + 2]};
}

// The system's right-hand side: the motion of handle nodes without rows is prescribed, so their terms move to the
// right.
Vector right_side(const Tissue& tissue, double h, const std::vector<dvec3>* push) {
  Vector right = tissue.right().head(3 * tissue.moving());
  for (const Tissue::Entry& entry : tissue.outer()) {
    const dvec3 v = tissue.velocity()[entry.column];
    right.segment<3>(3 * entry.row) -= entry.value * Eigen::Vector3d(v.x, v.y, v.z);
  }
  if (push)
    for (std::uint32_t i = 0; i < tissue.moving(); ++i)
      right.segment<3>(3 * i) += h * Eigen::Vector3d((*push)[i].x, (*push)[i].y, (*push)[i].z);
  return right;
}

// The function that a step of h with a law for large strain minimises (without stiffness damping), at the current
// positions [J]:
//   |x - begin - h v0|^2_M / 2h^2 (1 + h alpha) + E(x) - x . (M g + push).
class StepEnergy {
 public:
  StepEnergy(const Tissue& tissue, const std::vector<dvec3>& begin, double h, dvec3 gravity,
             const std::vector<dvec3>* push)
      : tissue_(tissue), begin_(begin), h_(h), gravity_(gravity), push_(push) {}

  double operator()() const {
    const double alpha = tissue_.material().alpha;
    double out = tissue_.elastic_energy();
    for (std::uint32_t i = 0; i < tissue_.moving(); ++i) {
      const double m = tissue_.mass()[i];
      const dvec3 v = (tissue_.position()[i] - begin_[i]) / h_, d = v - tissue_.velocity()[i];
      out += 0.5 * m * (dot(d, d) + h_ * alpha * dot(v, v)) - h_ * m * dot(v, gravity_);
      if (push_) out -= h_ * dot(v, (*push_)[i]);
    }
    return out;
  }

 private:
  const Tissue& tissue_;
  const std::vector<dvec3>& begin_;
  double h_;
  dvec3 gravity_;
  const std::vector<dvec3>* push_;
};

constexpr int kMostHalvings = 40;
constexpr double kEnergyNoise = 1e-13;  // [1] rounding of energies

}  // namespace

TissueReport step_tissue(Tissue& tissue, LinearSolver& solver, double T, dvec3 gravity, const TissueStep& step) {
  // The midpoint rule is an implicit Euler step of half the length, then an extrapolation by the same amount.
  const bool midpoint = step.scheme == Scheme::kMidpoint;
  const double h = midpoint ? T / 2 : T;
  const std::vector<dvec3> begin = tissue.position();
  std::vector<dvec3>& x = tissue.position();
  std::vector<dvec3>& v = tissue.velocity();
  Vector now = Vector::Zero(3 * tissue.moving()), last = now;
  TissueReport report;
  const auto take = [&](const Vector& mean) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = begin[i] + h * (i < tissue.moving() ? node_of(mean, i) : v[i]);
  };
  // Newton's way to `now` is shortened until the energy falls. False: it does not, to rounding.
  const StepEnergy energy(tissue, begin, h, gravity, step.push);
  const bool searches = step.iterations > 1 && tissue.large_strain() && tissue.material().beta == 0.0;
  const auto search = [&] {
    take(last);
    const double before = energy();
    for (int i = 0; i < kMostHalvings; ++i, now = 0.5 * (last + now)) {
      take(now);
      if (energy() <= before + kEnergyNoise * std::abs(before)) return true;
    }
    return false;
  };
  while (report.iterations < step.iterations) {
    tissue.assemble(h, gravity, report.iterations > 0 ? &begin : nullptr);
    solver.place(tissue.position());
    report.solved = solver.factorise(tissue.inner());
    if (!report.solved) {
      x = begin;
      return report;
    }
    last = now;
    solver.solve(right_side(tissue, h, step.push), now);
    ++report.iterations;
    if (searches && !search()) {
      now = last, report.change = 0.0;
      break;
    }
    const double size = now.norm();
    report.change = size > 0 ? (now - last).norm() / size : 0.0;
    if (report.change <= step.tolerance) break;
    take(now);
  }
  if (step.iterations == 1 && tissue.large_strain()) {
    x = begin;
    const std::vector<dvec3> none(x.size(), dvec3(0));
    now *= passive_share(tissue, none, now, tissue.moving(), h);
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const dvec3 mean = i < tissue.moving() ? node_of(now, i) : v[i];
    x[i] = begin[i] + T * mean;
    v[i] = midpoint && i < tissue.moving() ? 2.0 * mean - v[i] : mean;
  }
  tissue.end_step(T);
  return report;
}

TissueReport settle_tissue(Tissue& tissue, LinearSolver& solver, dvec3 gravity, TissueStep step) {
  step.scheme = Scheme::kEuler;
  std::fill(tissue.velocity().begin(), tissue.velocity().end(), dvec3(0));
  const TissueReport report = step_tissue(tissue, solver, kForever, gravity, step);
  std::fill(tissue.velocity().begin(), tissue.velocity().end(), dvec3(0));
  return report;
}

double kinetic_energy(const Tissue& tissue) {
  double energy = 0.0;
  for (std::size_t i = 0; i < tissue.mass().size(); ++i)
    energy += 0.5 * tissue.mass()[i] * dot(tissue.velocity()[i], tissue.velocity()[i]);
  return energy;
}

}  // namespace pliant
