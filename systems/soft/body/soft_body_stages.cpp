// A soft body's other steps than implicit Euler: in two stages (two_stages.h), and the equilibrium of every step. That
// is an Euler step from rest, so long that inertia is a millionth of what it is in a step of T, done in T: its matrix
// (M + h^2 K) (T / h)^2 is T^2 K, with no mass and no damping.
#include <algorithm>

#include "systems/soft/body/soft_body_state.h"

namespace pliant {

namespace {

constexpr double kQuasiStatic = 1000.0;  // [1] h / T

}  // namespace

void SoftBodyState::choose_step(StepMethod method) {
  if (method == StepMethod::kSecondOrder) {
    const auto even = [](const ElementFactors& f) { return f.damping == 1.0; };
    stages_.emplace(std::all_of(tets_.factors.begin(), tets_.factors.end(), even));
    stage_ = response_ = TwoStages::kShare;
  } else if (method == StepMethod::kQuasiStatic) {
    stage_ = kQuasiStatic;
    response_ = stage_ * stage_;
  }
}

void SoftBodyState::first_stage() {
  stages_->restart(velocity_);
  note_free_motion();
}

void SoftBodyState::second_stage() {
  stages_->turn(tissue_, solver_, velocity_);
  note_free_motion();
}

StepSplit SoftBodyState::split(double T) const {
  StepSplit out{T, damping_};
  if (stages_) out.of_mass = 1.0 / stage_, out.of_stiffness = stage_;
  if (quasi_static()) out.of_mass = 1.0 / response_, out.damping = {};
  return out;
}

void SoftBodyState::advance_stages(double T) {
  if (!velocity_.allFinite()) return halt();
  const bool free = tissue_.moving() == tets_.node_count();
  const TwoStages::End end = stages_->finish(tissue_, velocity_, T / T_, free);
  shortened_ = end.shortened;
  for (std::uint32_t i = 0; i < tissue_.moving(); ++i) {
    tissue_.position()[i] += T * node_velocity(i, end.motion);
    tissue_.velocity()[i] = node_velocity(i, end.velocity);
  }
  velocity_ = end.velocity;
  refresh_surface(tissue_.position(), surface_position);
}

}  // namespace pliant
