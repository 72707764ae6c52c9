// Drives of hinges and sliders: springs whose rest moves (methods.md 2.16).
#include <algorithm>
#include <cmath>

#include "systems/soft/joint/joints.h"

namespace pliant {
namespace {

bool is_driven(const Joint& joint) {
  const bool free = joint.kind == JointKind::kHinge || joint.kind == JointKind::kSlider;
  return free && (joint.hand != kNoEntity || !joint.target.empty());
}

// [J] held by its spring, `off` [rad], [m] from rest: beyond its bound the force is constant.
double held_by(const Joint& joint, double off) {
  const double free = 0.5 * joint.stiffness * off * off, most = joint.max_force;
  if (!(most > 0.0) || joint.stiffness * std::abs(off) <= most) return free;
  return most * (std::abs(off) - 0.5 * most / joint.stiffness);
}

}  // namespace

double Joints::rest_at(const Joint& joint, double grip, double time) {
  double rest = joint.rest;
  if (!joint.target.empty()) {
    PrescribedMotion clock;
    clock.repeats = joint.repeats, clock.speed = joint.speed;
    rest = std::clamp(sample_vector(joint.target, track_time(joint.target, clock, time).time).x,
                      JointRange::kLimits.min, JointRange::kLimits.max);
  }
  return joint.hand == kNoEntity ? rest : rest + grip * (joint.closed - rest);
}

void Joints::drive(const std::vector<std::unique_ptr<Body>>& bodies, JointState& state, Tick tick) const {
  if (!is_driven(state.joint) || !state.a.rigid || !state.b.rigid) return;
  const Pose a = frame_of(bodies, state.a, 0.0), b = frame_of(bodies, state.b, 0.0);
  const double at =
      state.joint.kind == JointKind::kHinge ? state.turned : dot(a.position - b.position, b.rotation * dvec3(0, 1, 0));
  const double was = state.target;
  state.target = rest_at(state.joint, state.grip, tick.time + tick.dt);
  state.report.fed += held_by(state.joint, at - state.target) - held_by(state.joint, at - was);
}

void Joints::set_grip(Entity hand, double grip) {
  for (JointState& state : joints_)
    if (state.joint.hand == hand && hand != kNoEntity) state.grip = std::clamp(grip, 0.0, 1.0);
}

double Joints::fed() const {
  double sum = 0.0;
  for (const JointState& state : joints_) sum += state.report.fed;
  return sum;
}

}  // namespace pliant
