// One step of all soft and rigid bodies (P2; methods.md 2.1-2.6). A body that fails stops and reports it: a failed
// factorisation, or a non-finite motion, must not spread through the contacts.
#include "systems/soft/soft_step.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/contact/contact_budget.h"
#include "systems/soft/soft_state.h"

namespace pliant {
namespace {

// Looser: stacks and grips creep. 1e-6 of gravity's velocity change per step is 0.2 um/s.
constexpr SweepLimits kSweeps{.sweeps = 200, .tolerance = 1e-6, .newtons = 60};

constexpr double kShortOf = 0.9;     // [1] of the motion up to a crossing
constexpr double kLeastPart = 0.02;  // [1] of a step: a shorter remainder does not become a part

// Successive steps without convergence after which bodies count as wedged: an impact takes fewer.
constexpr int kWedgedAfter = 20;
// Steps between two attempts to push bodies out of each other that were wedged in the last one: an attempt that fails
// costs several steps.
constexpr std::uint64_t kAttempts = 30;

constexpr double kSunken = 0.01;  // [1] of a body's diagonal: larger initial penetrations are reported

void change(Body& body, const DeformableParameters& now) {
  if (body.kind == BodyKind::kSurface) static_cast<YieldingBody&>(body).set(now);
}
void change(Body& body, const RigidSetting& now) {
  body.friction_static = now.friction_static;
  body.friction_sliding = now.friction_sliding;
  if (body.size() > 0) body.set_mass(now.mass);
}
void change(Body& body, const SoftSetting& now) {
  body.friction_static = now.friction_static;
  body.friction_sliding = now.friction_sliding;
  body.set_material(now.material);
}
void change(Body& body, const CouplingSetting& now) {
  if (auto* tool = body.as_tool()) tool->set_coupling(now);
}

// Removes contacts with a body that has no solution in this step.
void leave_out_failed(SoftState& soft) {
  const auto failed = [&](const ContactPoint& contact) {
    return !soft.bodies[contact.body_a]->solvable() || !soft.bodies[contact.body_b]->solvable();
  };
  soft.contacts.erase(std::remove_if(soft.contacts.begin(), soft.contacts.end(), failed), soft.contacts.end());
}

// Solves begin with the last step's forces: a late or parted step has another length.
void scale_impulses(SoftState& soft, double T) {
  if (soft.impulse_time > 0.0 && soft.impulse_time != T)
    for (ContactPoint& contact : soft.contacts) contact.impulse *= T / soft.impulse_time;
  soft.impulse_time = T;
}

// Records bodies that the level places into each other.
void tally_beginning(SoftState& soft) {
  const auto size = [&](std::uint32_t body) {
    return static_cast<double>(soft.bodies[body]->collision_mesh->box.diagonal());
  };
  for (const ContactPoint& c : soft.contacts) {
    const double least = kSunken * std::min(size(c.body_a), size(c.body_b));
    if (c.depth <= std::max(soft.tally.began_inside, least)) continue;
    soft.tally.began_inside = c.depth;
    soft.tally.inside_a = c.body_a, soft.tally.inside_b = c.body_b;
  }
}

// Stops bodies with a non-finite velocity.
void stop_non_finite(SoftState& soft) {
  for (const std::uint32_t i : soft.moving) {
    if (soft.bodies[i]->velocity().allFinite()) continue;
    soft.dropped |= kDroppedMotion;
    soft.bodies[i]->halt();
  }
}

// [J] What gravity gives to rigid bodies that are joined, in T [s]: weight of a tool's fingers moves the hand.
double given_by_weight(const SoftState& soft, dvec3 gravity, double T) {
  double sum = 0.0;
  for (const std::uint32_t i : soft.moving) {
    const RigidState* const body = soft.bodies[i]->as_rigid();
    if (!body || body->joined.empty() || body->carried) continue;
    const Vector& v = body->velocity();
    sum += T * body->mass().mass * dot(gravity, dvec3(v[0], v[1], v[2]));
  }
  return sum;
}

// Prevents tunnelling: bodies stop before a crossing that no contact prevents. The remainder of the step becomes an
// additional part, which has these contacts from its beginning.
void stop_before(SoftState& soft, const Crossings& left, double T) {
  soft.share = 1.0;
  if (left.count == 0) return;
  soft.share = kShortOf * left.first;
  ++soft.tally.halted;
  if (soft.more > 0 && (1.0 - soft.share) * T > kLeastPart * soft.step) --soft.more, ++soft.parts;
}

}  // namespace

void take_edits(World& world, Tick tick) {
  if (!world.soft) return;
  SoftState& soft = *world.soft;
  for (ParameterEdit edit; soft.parameter_edits.pop(edit);)
    for (const std::unique_ptr<Body>& body : soft.bodies)
      if (body->entity == edit.body) std::visit([&](const auto& now) { change(*body, now); }, edit.now);
  for (auto [entity, varying] : world.registry.view<const Varying>())
    for (const std::uint32_t i : soft.yielding)
      if (soft.bodies[i]->entity == entity) static_cast<YieldingBody&>(*soft.bodies[i]).vary(varying, tick.time);
  take_body_edits(world);
}

void free_motion(World& world, Tick tick) {
  if (!world.soft) return;
  SoftState& soft = *world.soft;
  const std::uint64_t begin = now_ns();
  for (const KinematicBody& led : soft.kinematic)
    lead(world, led, static_cast<FixedBody&>(*soft.bodies[led.body]), tick);
  for (const std::unique_ptr<Body>& body : soft.bodies) {
    if (body->taken_out) continue;
    body->free_step(tick.dt, world.simulation.gravity);
    if (body->solvable()) {
      take_loads(*body, tick.dt);
      continue;
    }
    soft.dropped |= kDroppedFactor;
    body->halt();
  }
  stop_non_finite(soft);
  soft.times.free_motion = ms_since(begin);
}

void find_contacts(World& world, Tick tick) {
  if (!world.soft) return;
  SoftState& soft = *world.soft;
  const std::uint64_t begin = now_ns();
  scale_impulses(soft, tick.dt);
  soft.joints.take_out(soft.contacts);
  soft.split.remember(soft.contacts);
  soft.proximity->find(soft.bodies, tick.dt, soft.contacts);
  leave_out_failed(soft);
  soft.split.place(soft.bodies, tick.dt, soft.contacts);
  soft.tally.contacts_cut += cut_contacts(soft.bodies, kMostOfBody, soft.contacts);
  for (const std::uint32_t i : soft.yielding) soft.surface(i).place(soft.contacts, i, tick.dt);
  soft.joints.place(soft.bodies, tick, soft.contacts);
  for (const ContactPoint& contact : soft.contacts) soft.tally.deepest = std::max(soft.tally.deepest, contact.depth);
  if (soft.steps == 0) tally_beginning(soft);
  soft.times.proximity = ms_since(begin);
}

void solve_contacts(World& world, Tick tick) {
  if (!world.soft) return;
  SoftState& soft = *world.soft;
  const std::uint64_t begin = now_ns();
  const bool wedged = soft.unsettled >= kWedgedAfter;
  const double undone =
      wedged && soft.report.left_inside && soft.steps % kAttempts != 0 ? 0.0 : soft.undone_in(tick.dt);
  build_problem(soft.bodies, soft.contacts, tick.dt, undone, soft.delassus, soft.problem);
  soft.times.delassus = ms_since(begin);
  const std::uint64_t built = now_ns();
  Crossings crossings;
  soft.report = solve_and_apply(soft.bodies, *soft.proximity, tick.dt, undone, kSweeps, soft.delassus, soft.contacts,
                                soft.problem, &crossings, &soft.joints, wedged);
  soft.unsettled = soft.report.settled && !soft.report.left_inside ? 0 : soft.unsettled + 1;
  soft.joints.measure(soft.bodies, soft.contacts, tick);
  soft.tally.fed += energy_given(soft.bodies, soft.contacts);
  stop_before(soft, crossings, tick.dt);
  soft.times.sweeps = ms_since(built);
  soft.tally.unconverged += soft.settled && !soft.report.settled;
  soft.settled = soft.settled && soft.report.settled;
  soft.tally.residual = std::max(soft.tally.residual, soft.report.residual);
  stop_non_finite(soft);
}

void advance_bodies(World& world, Tick tick) {
  if (!world.soft) return;
  SoftState& soft = *world.soft;
  const double dt = soft.share * tick.dt;
  soft.tally.fed += given_by_weight(soft, world.simulation.gravity, dt);
  for (const std::unique_ptr<Body>& body : soft.bodies) {
    if (body->taken_out) continue;
    body->advance(dt);
    if (body->shortened()) soft.dropped |= kDroppedGain;
  }
  for (const std::uint32_t i : soft.yielding) soft.surface(i).yield(soft.contacts, dt);
}

}  // namespace pliant
