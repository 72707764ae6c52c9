#include "systems/soft/joint/joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "systems/soft/body/rigid_state.h"
#include "systems/touch/collide/surface_query.h"

namespace pliant {
namespace {

constexpr double kArm = 0.25;            // [1] of the smaller body's diagonal
constexpr double kCorrected = 0.2;       // [1] of a rigid row's gap that an earlier step left: more adds energy
constexpr double kAtBound = 1.0 - 1e-9;  // [1] of a spring's bound
constexpr std::uint64_t kJointKey = std::uint64_t{1} << 63;
constexpr std::uint8_t kAll = 7, kFirst = 1, kAcross = 6;  // axes that a row holds

// A right-handed frame with this first axis.
dmat3 axes_along(dvec3 first, dvec3 second) {
  return dmat3(first, second, cross(first, second));
}
dmat3 axes_along(dvec3 first) {
  const dvec3 aside = std::abs(first.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return axes_along(first, normalize(cross(first, aside)));
}

// Points of the joint that hold its directions, in its frame and in arms.
constexpr dvec3 kOut[] = {dvec3(0, 0, 0), dvec3(0, 1, 0), dvec3(1, 0, 0)};

std::size_t held_points(JointKind kind) {
  return kind == JointKind::kFixed ? 3 : kind == JointKind::kHinge ? 2 : 1;
}

bool has_free_axis(JointKind kind) {
  return kind == JointKind::kHinge || kind == JointKind::kSlider;
}
bool has_spring(const Joint& joint) {
  return joint.stiffness > 0.0 || joint.damping > 0.0;
}
bool has_limits(const Joint& joint) {
  return joint.limits[0] < joint.limits[1];
}

// [rad] of a against b about b's +Y, near `near`.
double angle_of(const Pose& a, const Pose& b, double near) {
  const dvec3 x = glm::conjugate(b.rotation) * (a.rotation * dvec3(1, 0, 0));
  const double angle = std::atan2(-x.z, x.x);
  return angle + 2.0 * M_PI * std::round((near - angle) / (2.0 * M_PI));
}

}  // namespace

// The joint of two rigid bodies: the rows of its frames.
void Joints::add_frames(const JointState& state, const Pose& a, const Pose& b, Rows& out) {
  const dmat3 f = glm::mat3_cast(b.rotation);
  const dmat3 from_y(f[1], f[2], f[0]), from_z(f[2], f[0], f[1]);
  const bool slides = state.joint.kind == JointKind::kSlider;
  const dvec3 along = slides ? dot(a.position - b.position, f[1]) * f[1] : dvec3(0.0);
  const auto hold = [&](int i, const dmat3& axes, std::uint8_t held) {
    Row row;
    row.a.position = a.to_world(state.arm * kOut[i]);
    row.b.position = b.to_world(state.arm * kOut[i]) + along;
    row.axes = axes, row.held = held;
    row.off = (row.a.position - row.b.position) * axes;
    out.push_back(row);
  };
  hold(0, from_y, slides ? kAcross : kAll);
  if (state.joint.kind == JointKind::kBall) return;
  hold(1, from_y, kAcross);
  if (state.joint.kind != JointKind::kHinge) hold(2, from_z, kFirst);
  if (has_free_axis(state.joint.kind)) add_free_axis(state, a, b, out);
}

// Spring and limits of a hinge, by a point that turns about it, or of a slider.
void Joints::add_free_axis(const JointState& state, const Pose& a, const Pose& b, Rows& out) {
  const Joint& joint = state.joint;
  const dvec3 axis = b.rotation * dvec3(0, 1, 0);
  const bool turns = joint.kind == JointKind::kHinge;
  const double arm = turns ? state.arm : 1.0;
  const double at = turns ? angle_of(a, b, state.turned) : dot(a.position - b.position, axis);
  const dvec3 out_there = a.rotation * dvec3(1, 0, 0);
  const dvec3 way = turns ? normalize(cross(axis, out_there)) : axis;
  Row row;
  row.a.position = row.b.position = turns ? a.to_world(dvec3(arm, 0, 0)) : a.position;
  const auto push = [&](double off, double sign, std::uint8_t held) {
    row.axes = axes_along(sign * way), row.held = held, row.off = {arm * off, 0.0, 0.0};
    out.push_back(row);
  };
  if (has_limits(joint)) {
    push(at - joint.limits[0], 1.0, 0);
    push(joint.limits[1] - at, -1.0, 0);
  }
  if (!has_spring(joint)) return;
  row.stiffness = joint.stiffness / (arm * arm), row.damping = joint.damping / (arm * arm);
  if (joint.max_force > 0.0) row.most = joint.max_force / arm;
  push(at - state.target, 1.0, kFirst);
}

void Joints::find_rows(const std::vector<std::unique_ptr<Body>>& bodies, const JointState& state, double T,
                       Rows& out) const {
  out.clear();
  const Joint& joint = state.joint;
  Row row;
  if (joint.kind == JointKind::kRope) {
    row.a = point_of(bodies, state.a, 0, T), row.b = point_of(bodies, state.b, 0, T);
    const dvec3 to_b = row.b.position - row.a.position;
    const double apart = length(to_b);
    row.axes = axes_along(apart > 0.0 ? to_b / apart : dvec3(0, 1, 0));
    row.off.x = joint.length - apart;
    row.stiffness = joint.stiffness, row.damping = row.off.x < 0.0 ? joint.damping : 0.0;
    out.push_back(row);
    return;
  }
  if (state.a.rigid && state.b.rigid) {
    add_frames(state, frame_of(bodies, state.a, T), frame_of(bodies, state.b, T), out);
    for (Row& each : out) each.a.part = state.a.part, each.b.part = state.b.part;
    return;
  }
  for (std::size_t i = 0; i < held_points(joint.kind); ++i) {
    row.a = point_of(bodies, state.a, i, T), row.b = point_of(bodies, state.b, i, T);
    row.held = kAll;
    row.off = row.a.position - row.b.position - state.apart[i];
    out.push_back(row);
  }
}

Status Joints::prepare(const World& world, std::vector<std::unique_ptr<Body>>& bodies) {
  for (auto [entity, joint] : world.registry.view<Joint>())
    if (Status s = add(world, entity, joint, bodies); !s) return s;
  carry_parts(world, bodies);
  return Done{};
}

Status Joints::add(const World& world, Entity entity, const Joint& joint, std::vector<std::unique_ptr<Body>>& bodies) {
  const Name* const name = world.registry.find<Name>(entity);
  JointState state;
  state.joint = joint, state.target = rest_at(joint, 0.0, 0.0),
  state.name = name ? name->value : fmt::format("entity {}", entity.index);
  const std::string where = "joint `" + state.name + "`";
  const auto body_of = [&](Entity of) {
    const auto found = std::find_if(bodies.begin(), bodies.end(), [&](const auto& b) { return b->entity == of; });
    if (found == bodies.end()) {  // the world
      bodies.push_back(std::make_unique<FixedBody>(*nothing_, Pose{}));
      bodies.back()->entity = kNoEntity, bodies.back()->absent = true;
      return static_cast<std::uint32_t>(bodies.size() - 1);
    }
    return static_cast<std::uint32_t>(found - bodies.begin());
  };
  state.a.body = body_of(joint.body_a), state.b.body = body_of(joint.body_b);
  Body &a = *bodies[state.a.body], &b = *bodies[state.b.body];
  if (a.size() == 0 && b.size() == 0)
    return Error{where, "joins what does not move: both sides are fixed", "join a body that moves, or remove it"};
  const Result<std::int32_t> of_a = part_of(world, a, where, joint.part_a),
                             of_b = part_of(world, b, where, joint.part_b);
  if (!of_a) return of_a.error();
  if (!of_b) return of_b.error();
  state.a.part = *of_a, state.b.part = *of_b;
  state.a.rigid = *of_a >= 0 || a.pose_after(0.0), state.b.rigid = *of_b >= 0 || b.pose_after(0.0);
  const bool tissue = !state.a.rigid || !state.b.rigid;
  if (tissue && (joint.kind == JointKind::kSlider ||
                 (joint.kind == JointKind::kHinge && (has_limits(joint) || has_spring(joint)))))
    return Error{where, "is a slider, or a hinge with limits or a spring, of tissue, which has no single direction",
                 "join a rigid part of it (`part_a`, `part_b`), or a rigid body that is `fixed` to it"};

  double arm = HUGE_VAL;
  for (const Body* body : {&a, &b})
    if (body->collision_mesh->vertex_count > 0)
      arm = std::min(arm, kArm * static_cast<double>(body->collision_mesh->box.diagonal()));
  state.arm = arm;
  const Pose frame = world.registry.get<Pose>(entity);
  const auto place = [&](Side& side, bool at_end) {
    const Body& body = *bodies[side.body];
    const Pose* const begun = body.entity == kNoEntity ? nullptr : world.registry.find<Pose>(body.entity);
    const Pose pose = side.rigid ? pose_of(body, side, 0.0) : begun ? *begun : Pose{};
    side.frame = {pose.to_local(frame.position), glm::conjugate(pose.rotation) * frame.rotation};
    for (std::size_t i = 0; i < kMostPoints; ++i) {
      const dvec3 local = pose.to_local(frame.to_world(at_end ? joint.end : arm * kOut[i]));
      side.point[i] = local;
      if (side.rigid) continue;
      const SurfaceFoot foot = nearest(*body.collision_mesh, local, HUGE_VAL);
      side.on[i].triangle = foot.triangle, side.on[i].barycentric = foot.barycentric;
    }
  };
  place(state.a, false), place(state.b, joint.kind == JointKind::kRope);
  if (joint.kind == JointKind::kRope) {
    const double apart =
        length(point_of(bodies, state.a, 0, 0.0).position - point_of(bodies, state.b, 0, 0.0).position);
    if (!(state.joint.length > 0.0)) state.joint.length = apart;
  } else if (tissue) {
    for (std::size_t i = 0; i < held_points(joint.kind); ++i) {
      Side* const rigid = state.a.rigid ? &state.a : state.b.rigid ? &state.b : nullptr;
      const dvec3 on = point_of(bodies, state.a.rigid ? state.b : state.a, i, 0.0).position;
      if (rigid)
        rigid->point[i] = pose_of(*bodies[rigid->body], *rigid, 0.0).to_local(on);
      else
        state.apart[i] = on - point_of(bodies, state.b, i, 0.0).position;
    }
  }
  if (&a != &b) a.joined.push_back(&b), b.joined.push_back(&a);
  joints_.push_back(std::move(state));
  return Done{};
}

void Joints::take_out(std::vector<ContactPoint>& contacts) {
  if (joints_.empty()) return;
  for (JointState& state : joints_) state.impulse.fill(dvec3(0.0));
  for (const ContactPoint& c : contacts)
    if (c.hold.joint >= 0) joints_[static_cast<std::size_t>(c.hold.joint)].impulse[c.key % kMostRows] = c.impulse;
  std::erase_if(contacts, [](const ContactPoint& c) { return c.hold.joint >= 0; });
}

void Joints::place(const std::vector<std::unique_ptr<Body>>& bodies, Tick tick, std::vector<ContactPoint>& contacts) {
  const double T = tick.dt;
  end_ = tick.time + T;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    JointState& state = joints_[j];
    Body &a = *bodies[state.a.body], &b = *bodies[state.b.body];
    if (state.report.broke_at >= 0.0) {
      std::erase(a.joined, &b), std::erase(b.joined, &a);
      continue;
    }
    if (a.taken_out || b.taken_out || !a.solvable() || !b.solvable()) continue;
    if (state.joint.kind == JointKind::kHinge && state.a.rigid && state.b.rigid)
      state.turned = angle_of(frame_of(bodies, state.a, 0.0), frame_of(bodies, state.b, 0.0), state.turned);
    drive(bodies, state, tick);
    find_rows(bodies, state, 0.0, rows_);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Row& row = rows_[r];
      ContactPoint c;
      c.body_a = state.a.body, c.body_b = state.b.body;
      c.a = row.a, c.b = row.b;
      c.axes = row.axes, c.normal = row.axes[0];
      c.mu_static = c.mu_sliding = 0.0;
      c.key = kJointKey / kMostRows * kMostRows + j * kMostRows + r;
      c.impulse = state.impulse[r];
      c.hold.joint = static_cast<std::int32_t>(j);
      c.hold.axes = row.held;
      c.hold.off = row.off;
      c.hold.rate = dvec3(1.0 / T);
      c.hold.off *= row.held != 0 && !(row.stiffness > 0.0 || row.damping > 0.0) ? kCorrected : 1.0;
      if (row.stiffness > 0.0 || row.damping > 0.0) {
        // lambda = -T (K (off + T u) + D u)
        const double both = row.damping + T * row.stiffness;
        c.hold.rate.x = row.stiffness / both;
        c.hold.softness.x = 1.0 / (T * both);
        c.hold.most = T * row.most;
      }
      if (row.held == 0) c.gap = row.off.x;
      for (int k = 0; k < 3; ++k)
        if (c.hold.softness[k] == 0.0 && (row.held >> k & 1) != 0)
          state.report.apart = std::max(state.report.apart, std::abs(row.off[k]));
      contacts.push_back(std::move(c));
    }
  }
}

double Joints::look_again(const std::vector<std::unique_ptr<Body>>& bodies, double T,
                          const std::vector<ContactPoint>& contacts, ContactProblem& problem) const {
  double worst = 0.0;  // [m]
  if (joints_.empty()) return worst;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    if (c.hold.joint < 0) continue;
    const std::size_t r = c.key % kMostRows;
    if (r == 0 || c.key != contacts[i - 1].key + 1)
      find_rows(bodies, joints_[static_cast<std::size_t>(c.hold.joint)], T, rows_);
    const dvec3 u = bodies[c.body_a]->velocity_of(c.a) - bodies[c.body_b]->velocity_of(c.b);
    for (int k = 0; k < 3; ++k) {
      if (c.hold.axes != 0 ? (c.hold.axes >> k & 1) == 0 : k > 0) continue;
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
      const double rate = c.hold.rate[k];
      const bool rigid = c.hold.axes != 0 && c.hold.softness[k] == 0.0;
      const double left = rigid ? (1.0 / kCorrected - 1.0) * c.hold.off[k] : 0.0;
      const double law = rate * (rows_[r].off[k] - left) + (1.0 - rate * T) * dot(c.axes[k], u) +
                         c.hold.softness[k] * problem.impulse[row];
      const double change = law - problem.velocity[row];
      problem.bias[row] += change;
      if (c.hold.axes != 0 || problem.impulse[row] > 0.0 || law < 0.0) worst = std::max(worst, T * std::abs(change));
    }
  }
  return worst;
}

double Joints::kinetic_energy(const std::vector<std::unique_ptr<Body>>& bodies) const {
  double sum = 0.0;
  pliant::Rows weighed;
  for (const std::unique_ptr<Body>& body : bodies) {
    if (body->joined.empty() || body->size() == 0) continue;
    const pliant::Rows v = body->velocity();
    body->weigh(v, weighed);
    sum += 0.5 * v.col(0).dot(weighed.col(0));
  }
  return sum;
}

void Joints::leave_gaps(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                        ContactProblem& problem) const {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    if (c.hold.joint < 0 || c.hold.axes == 0) continue;
    const dvec3 u = bodies[c.body_a]->velocity_of(c.a) - bodies[c.body_b]->velocity_of(c.b);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i) + k;
      if (c.hold.softness[k] == 0.0) problem.bias[row] -= problem.velocity[row] - dot(c.axes[k], u);
    }
  }
}

// K = -d(r x f)/d(turn), symmetric.
dmat3 Joints::turning_stiffness(const RigidState& body, dvec3 at, dvec3 force) {
  const dvec3 r = at - body.centre();
  return dmat3(dot(r, force)) - 0.5 * (glm::outerProduct(r, force) + glm::outerProduct(force, r));
}

bool Joints::stiffen(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                     const Vector& impulses, double T) const {
  if (joints_.empty()) return false;
  stiffness_.assign(bodies.size(), dmat3(0.0));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    if (c.hold.joint < 0) continue;
    const double* const l = &impulses[3 * static_cast<Eigen::Index>(i)];
    const dvec3 force = c.axes * dvec3(l[0], l[1], l[2]) / T;
    if (const RigidState* a = bodies[c.body_a]->as_rigid())
      stiffness_[c.body_a] += turning_stiffness(*a, c.a.position, force);
    if (const RigidState* b = bodies[c.body_b]->as_rigid())
      stiffness_[c.body_b] += turning_stiffness(*b, c.b.position, -force);
  }
  bool grew = false;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (!bodies[i]->joined.empty() && bodies[i]->stiffen_turning(stiffness_[i], T)) grew = true;
  return grew;
}

void Joints::measure(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                     Tick tick) {
  if (joints_.empty()) return;
  for (JointState& state : joints_) state.sum = dvec3(0.0);
  for (const ContactPoint& c : contacts) {
    if (c.hold.joint < 0) continue;
    const auto j = static_cast<std::size_t>(c.hold.joint);
    joints_[j].sum += c.axes * c.impulse;
    if (c.hold.axes != kFirst || !(c.hold.softness.x > 0.0)) continue;
    JointReport& report = joints_[j].report;
    const double arm = joints_[j].joint.kind == JointKind::kHinge ? joints_[j].arm : 1.0;
    report.push = arm * c.impulse.x / tick.dt;
    report.work +=
        c.impulse.x * dot(c.axes[0], bodies[c.body_a]->velocity_of(c.a) - bodies[c.body_b]->velocity_of(c.b));
    if (std::abs(c.impulse.x) >= kAtBound * c.hold.most) report.limited_for += tick.dt;
  }
  for (JointState& state : joints_) {
    state.report.force = length(state.sum) / tick.dt;
    load(state);
  }
}

}  // namespace pliant
