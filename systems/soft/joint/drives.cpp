// Drives of hinges and sliders: springs whose rest moves (methods.md 2.16).
#include <algorithm>
#include <cmath>

#include "components/soft_body.h"
#include "systems/soft/body/rigid_state.h"
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

void Joints::carry_parts(const World& world, const std::vector<std::unique_ptr<Body>>& bodies) const {
  for (bool grew = true; grew;) {
    grew = false;
    for (const JointState& state : joints_) {
      const Handle6* const tool = world.registry.find<Handle6>(state.joint.hand);
      if (!tool || !tool->carried || state.joint.strength > 0.0) continue;
      Body &a = *bodies[state.a.body], &b = *bodies[state.b.body];
      const auto is_part = [&](const Body& body) { return body.carried || body.entity == state.joint.hand; };
      const auto carry = [&](const Body& part, Body& next) {
        if (is_part(part) && next.as_rigid() && !next.carried) next.carried = grew = true;
      };
      carry(a, b), carry(b, a);
    }
  }
}

void Joints::set_grip(Entity hand, double grip) {
  for (JointState& state : joints_)
    if (state.joint.hand == hand && hand != kNoEntity) state.grip = std::clamp(grip, 0.0, 1.0);
}

void Joints::load(JointState& state) const {
  JointReport& report = state.report;
  report.largest = std::max(report.largest, report.force);
  if (state.joint.strength > 0.0 && report.force > state.joint.strength && report.broke_at < 0.0)
    report.broke_at = end_;
}

bool Joints::snap(const Vector& impulses, double T, std::vector<ContactPoint>& contacts) {
  if (std::none_of(joints_.begin(), joints_.end(), [](const JointState& s) { return s.joint.strength > 0.0; }))
    return false;
  for (JointState& state : joints_) state.sum = dvec3(0.0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].hold.joint < 0) continue;
    const double* const l = &impulses[3 * static_cast<Eigen::Index>(i)];
    joints_[static_cast<std::size_t>(contacts[i].hold.joint)].sum += contacts[i].axes * dvec3(l[0], l[1], l[2]);
  }
  bool any = false;
  for (JointState& state : joints_) {
    if (state.report.broke_at >= 0.0 || length(state.sum) <= T * state.joint.strength) continue;
    state.report.force = length(state.sum) / T;
    load(state);
    any |= state.report.broke_at >= 0.0;
  }
  const auto is_broken = [&](const ContactPoint& c) {
    return c.hold.joint >= 0 && joints_[static_cast<std::size_t>(c.hold.joint)].report.broke_at >= 0.0;
  };
  if (any) std::erase_if(contacts, is_broken);
  return any;
}

double Joints::fed() const {
  double sum = 0.0;
  for (const JointState& state : joints_) sum += state.report.fed;
  return sum;
}

}  // namespace pliant
