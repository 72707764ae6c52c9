#include "lab/study/time_step/step_schemes.h"

#include <algorithm>

namespace pliant {
namespace {

constexpr int kMostIterations = 30;
constexpr double kConvergedTo = 1e-9;  // [1] of the velocity, for convergence

int iterations_of(StepScheme scheme) {
  switch (scheme) {
    case StepScheme::kMidpointTwice:
      return 2;
    case StepScheme::kConverged:
      return kMostIterations;
    default:
      return 1;
  }
}

dvec3 node_of(const Vector& v, std::size_t node) {
  const Eigen::Index i = 3 * static_cast<Eigen::Index>(node);
  return {v[i], v[i + 1], v[i + 2]};
}

}  // namespace

const char* name_of(StepScheme scheme) {
  constexpr const char* kNames[] = {"Euler", "midpoint", "midpoint, two iterations", "BDF2", "converged"};
  return kNames[static_cast<std::size_t>(scheme)];
}

std::optional<Penetration> penetration(const Obstacle& obstacle, dvec3 place, double time) {
  if (const auto* ball = std::get_if<Ball>(&obstacle)) {
    const dvec3 away = place - ball->middle(time);
    const double far = length(away);
    if (!(far < ball->radius) || far == 0.0) return std::nullopt;
    return Penetration{ball->radius - far, away / far};
  }
  if (const auto* ground = std::get_if<Ground>(&obstacle); ground && place.y < ground->height)
    return Penetration{ground->height - place.y, dvec3(0, 1, 0)};
  return std::nullopt;
}

TissueRun::TissueRun(const TissueScene& scene, StepScheme scheme)
    : scene_(scene), scheme_(scheme), tissue_(scene.mesh, scene.material, scene.mesh.free_count) {
  for (std::uint32_t i = 0; i < scene.mesh.free_count; ++i) tissue_.velocity()[i] = scene.velocity;
  solver_ = make_solver(SolverKind::kBlockCholesky, tissue_.inner().size);
  solver_->analyse(tissue_.inner());
}

// Penalty of the obstacle at the end of the stage: k (depth - n (x - guess)), x = begin + h u. In the first iteration
// the guess is the tissue's free motion.
void TissueRun::push(double h, const std::vector<dvec3>& begin, bool first, Vector& right) {
  BlockMatrix& A = tissue_.inner();
  for (std::uint32_t i = 0; i < tissue_.moving(); ++i) {
    const dvec3 guess = first ? begin[i] + h * tissue_.velocity()[i] : tissue_.position()[i];
    const auto hit = penetration(scene_.obstacle, guess, time_ + h);
    if (!hit) continue;
    const Eigen::Vector3d n(hit->out.x, hit->out.y, hit->out.z);
    A.value[A.diagonal[i]] += h * h * scene_.stiffness * n * n.transpose();
    right.segment<3>(3 * i) += h * scene_.stiffness * (hit->depth + dot(guess - begin[i], hit->out)) * n;
  }
}

bool TissueRun::stage(double h, Vector& velocity) {
  std::vector<dvec3>& x = tissue_.position();
  const std::vector<dvec3> begin = x;
  Vector last = velocity;
  for (int k = 0; k < iterations_of(scheme_); ++k) {
    tissue_.assemble(h, scene_.gravity, k > 0 ? &begin : nullptr);
    Vector right = tissue_.right().head(3 * tissue_.moving());
    push(h, begin, k == 0, right);
    solver_->place(x);
    if (!solver_->factorise(tissue_.inner())) return false;
    last = velocity;
    solver_->solve(right, velocity);
    for (std::uint32_t i = 0; i < tissue_.moving(); ++i) x[i] = begin[i] + h * node_of(velocity, i);
    if (k > 0 && (velocity - last).norm() <= kConvergedTo * velocity.norm()) break;
  }
  return velocity.allFinite();
}

bool TissueRun::step(double T) {
  std::vector<dvec3>&x = tissue_.position(), &v = tissue_.velocity();
  const std::vector<dvec3> x0 = x, v0 = v;
  const bool two_steps = scheme_ == StepScheme::kBdf2 && !x_before_.empty();
  const bool midpoint =
      scheme_ == StepScheme::kMidpoint || scheme_ == StepScheme::kMidpointTwice || scheme_ == StepScheme::kConverged;
  if (two_steps)
    for (std::uint32_t i = 0; i < tissue_.moving(); ++i) {
      x[i] = (4.0 * x0[i] - x_before_[i]) / 3.0;
      v[i] = (4.0 * v0[i] - v_before_[i]) / 3.0;
    }
  // The stage of BDF2 is shorter than the step but ends with it.
  const double h = midpoint ? T / 2 : two_steps ? 2 * T / 3 : T, now = time_;
  if (two_steps) time_ += T - h;
  Vector velocity = Vector::Zero(3 * tissue_.moving());
  if (!stage(h, velocity)) return false;
  for (std::uint32_t i = 0; i < tissue_.moving(); ++i) {
    const dvec3 u = node_of(velocity, i);
    if (midpoint) x[i] = x0[i] + T * u;
    v[i] = midpoint ? 2.0 * u - v0[i] : u;
  }
  x_before_ = x0;
  v_before_ = v0;
  time_ = now + T;
  return true;
}

}  // namespace pliant
