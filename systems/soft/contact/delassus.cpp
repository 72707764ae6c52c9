#include "systems/soft/contact/delassus.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/contact/contact_budget.h"
#include "systems/soft/contact/contact_islands.h"
#include "systems/soft/contact/fill_operator.h"
#include "systems/soft/contact/rolling.h"
#include "systems/soft/joint/joints.h"
#include "systems/soft/local/smeared_response.h"
#include "systems/soft/local/smearing_surface.h"
#include "systems/soft/local/tip_law.h"

namespace pliant {
namespace {

constexpr int kRoundsUnsettled = 2;   // rounds after which a solution that did not converge is not extended
constexpr int kTipRoundsOfSolve = 8;  // of a probe's tips, whose laws are not linear: three are usual
constexpr double kTipSettled = 1e-5;  // [1] of their forces
constexpr double kJointApart = 1e-9;  // [m]
constexpr double kJointGains = 1.05;  // [1] of the energy without impulses: joints take, and may give that much
constexpr double kJointFalls = 0.5;   // [1] of the last round's
constexpr int kJointRounds = 4;       // in which joints are corrected to where rotations bring them
constexpr int kMostRounds = 8;        // in which contacts found by a solution join; a round reaches one body further

// The contacts of each body.
void sort_by_body(const std::vector<ContactPoint>& contacts, std::vector<BodyResponse>& of) {
  for (BodyResponse& response : of) response.contacts.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    of[c.body_a].contacts.push_back(static_cast<int>(i));
    if (c.body_b != c.body_a) of[c.body_b].contacts.push_back(static_cast<int>(i));
  }
}

// A body's sides of its contacts. Side a gets +lambda, side b -lambda; both sides of a self-contact are this body's.
void list_sides(std::uint32_t index, const std::vector<ContactPoint>& contacts, const BodyResponse& response,
                std::vector<PushedSide>& sides) {
  sides.clear();
  Eigen::Index own = 0;
  for (const int i : response.contacts) {
    const ContactPoint& c = contacts[static_cast<std::size_t>(i)];
    if (c.body_a == index) sides.push_back({own, &c.a, &c.axes, 1.0});
    if (c.body_b == index) sides.push_back({own, &c.b, &c.axes, -1.0});
    ++own;
  }
}

void find_compliances(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                      double T, Delassus& delassus) {
  const auto yields = [](const std::unique_ptr<Body>& body) { return body->yields(); };
  const auto is_soft = [](const ContactPoint& c) { return c.hold.softness != dvec3(0.0); };
  if (std::none_of(bodies.begin(), bodies.end(), yields) && std::none_of(contacts.begin(), contacts.end(), is_soft)) {
    delassus.compliance.resize(0, 0);
    return;
  }
  delassus.compliance.setZero(3 * static_cast<Eigen::Index>(contacts.size()),
                              3 * static_cast<Eigen::Index>(contacts.size()));
  std::vector<Body::Side> sides;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    sides.clear();
    for (const int i : delassus.of[b].contacts) {
      const ContactPoint& c = contacts[static_cast<std::size_t>(i)];
      sides.push_back({i, c.body_a == b ? &c.a : &c.b, &c.axes, c.body_a == b ? 1.0 : -1.0});
    }
    if (!sides.empty() && bodies[b]->yields()) bodies[b]->add_compliance(sides, T, delassus.compliance);
  }
  for (std::size_t i = 0; i < contacts.size(); ++i)
    for (int k = 0; k < 3; ++k)
      delassus.compliance.diagonal()[3 * static_cast<Eigen::Index>(i) + k] += contacts[i].hold.softness[k];
}

// [m/s] J v* of one side: every body interpolates its collision mesh linearly.
dvec3 free_velocity(const Body& body, const SurfacePoint& point) {
  if (point.smeared) return body.as_tissue()->free_velocity(*point.smeared);
  const uvec3 t = body.collision_mesh->triangles[point.triangle];
  const std::vector<dvec3>&x = body.surface_position, &v = body.surface_velocity;
  if (point.beside) {  // exact for a rigid motion: the triangle's normal turns with it
    const dvec3 e = x[t.y] - x[t.x], f = x[t.z] - x[t.x], n = cross(e, f), q = point.position - x[t.x];
    const dvec3 de = v[t.y] - v[t.x], df = v[t.z] - v[t.x], dn = cross(de, f) + cross(e, df);
    return v[t.x] + (dot(cross(q, f), n) * de + dot(cross(e, q), n) * df + dot(q, n) * dn) / dot(n, n);
  }
  return point.barycentric.x * body.surface_velocity[t.x] + point.barycentric.y * body.surface_velocity[t.y] +
         point.barycentric.z * body.surface_velocity[t.z];
}

// [m] Part of a penetration that this step does not correct, if nothing yields.
double still_inside(const ContactPoint& c, std::size_t i, double beta, const Delassus& delassus) {
  const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
  const bool yields = delassus.compliance.size() > 0 && delassus.compliance(row, row) > 0.0;
  return yields ? 0.0 : (1.0 - beta) * c.depth;
}

// [m] Of a split contact's law, linear in this solve.
double offset_of(const std::vector<std::unique_ptr<Body>>& bodies, const ContactPoint& c) {
  if (!c.b.smeared) return 0.0;
  const SoftBodyState& tissue = *bodies[c.body_b]->as_tissue();
  return tip_offset(*c.b.smeared, tissue.elasticity(), tissue.smearing()->layer());
}

// Makes the laws of a probe's tips linear about the solution's forces. False: they are already.
bool linearise_tips(const std::vector<std::unique_ptr<Body>>& bodies, double T, std::vector<ContactPoint>& contacts,
                    Delassus& delassus, ContactProblem& problem) {
  bool changed = false;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ContactPoint& c = contacts[i];
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    if (!c.b.smeared || !(c.b.smeared->tip_radius > 0.0)) continue;
    const double force = problem.impulse[row] / T;
    if (!(force > 0.0) || std::abs(force - c.b.smeared->tip_force) <= kTipSettled * force) continue;
    ContactProblem& part =
        problem.part_count > 0 ? problem.parts[static_cast<std::size_t>(problem.place[i].first)] : problem;
    if (!part.sparse.first.empty()) continue;  // a heap: the next step goes on from here
    const SoftBodyState& tissue = *bodies[c.body_b]->as_tissue();
    const LocalElasticity elastic = tissue.elasticity();
    const LayerKernel& layer = tissue.smearing()->layer();
    auto next = std::make_shared<SmearedLoad>(*c.b.smeared);
    next->tip_force = force;
    const Block axes = to_block(glm::transpose(c.axes) * next->turn);
    const Block change = axes *
                         (self_compliance(*next, elastic, layer) - self_compliance(*c.b.smeared, elastic, layer)) *
                         axes.transpose() / (T * T);
    const Eigen::Index at = problem.part_count > 0 ? 3 * static_cast<Eigen::Index>(problem.place[i].second) : row;
    part.W.block<3, 3>(at, at) += change;
    delassus.compliance.block<3, 3>(row, row) += change;
    problem.bias[row] += (tip_offset(*next, elastic, layer) - tip_offset(*c.b.smeared, elastic, layer)) / T;
    c.b.smeared = std::move(next);
    changed = true;
  }
  return changed;
}

// The local displacement of split contacts, whole at every step's end.
void keep_strain(const std::vector<std::unique_ptr<Body>>& bodies, double T, const Delassus& delassus,
                 const ContactProblem& problem, std::vector<ContactPoint>& contacts) {
  const auto rows = static_cast<Eigen::Index>(3 * contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ContactPoint& c = contacts[i];
    if (!c.a.smeared && !c.b.smeared) continue;
    c.strained = dvec3(0.0);
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    const auto displaced = [&](int k) {
      return T * delassus.compliance.row(row + k).head(rows).dot(problem.impulse.head(rows));
    };
    const bool pressed = problem.impulse[row] > 0.0, by_spring = c.b.smeared && c.b.smeared->spring.of;
    c.dented = pressed ? displaced(0) + offset_of(bodies, c) : by_spring ? c.b.smeared->spring.depth(0.0) : 0.0;
    if (by_spring) c.relaxed = c.b.smeared->spring.relaxed_after(c.dented);
    if (!pressed) continue;
    for (int k = 1; k < 3; ++k) c.strained += displaced(k) * c.axes[k];
  }
}

// u without impulses, from the bodies' surface_velocity.
void find_bias(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts, double T,
               double beta, const Delassus& delassus, ContactProblem& problem) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    if (c.hold.joint >= 0) {
      const dvec3 u = bodies[c.body_a]->velocity_of(c.a) - bodies[c.body_b]->velocity_of(c.b);
      for (int k = 0; k < 3; ++k) problem.bias[row + k] = dot(c.axes[k], u) + c.hold.rate[k] * c.hold.off[k];
      continue;
    }
    const dvec3 u = free_velocity(*bodies[c.body_a], c.a) - free_velocity(*bodies[c.body_b], c.b);
    for (int k = 0; k < 3; ++k) problem.bias[row + k] = dot(c.axes[k], u);
    problem.bias[row] += (c.gap + still_inside(c, i, beta, delassus) + offset_of(bodies, c)) / T;
    for (int k = 1; k < 3; ++k) problem.bias[row + k] -= dot(c.axes[k], c.strained) / T;
  }
}

// The guess of a solve: the last step's impulses.
void take_impulses(const std::vector<ContactPoint>& contacts, ContactProblem& problem) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (int k = 0; k < 3; ++k) problem.impulse[3 * static_cast<Eigen::Index>(i) + k] = contacts[i].impulse[k];
    problem.sliding[i] = contacts[i].sliding;
  }
}

// After a step's solution.
void keep_slip(const ContactProblem& problem, double T, std::vector<ContactPoint>& contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    ContactPoint& c = contacts[i];
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    const double mu = c.sliding ? c.mu_sliding : c.mu_static, limit = (1.0 - 1e-6) * mu * c.impulse.x;
    const bool at_limit = c.impulse.x > 0.0 && length(dvec2(c.impulse.y, c.impulse.z)) >= limit;
    c.slipped = at_limit ? c.slipped + T * problem.velocity.segment<2>(row + 1).norm() : 0.0;
  }
}

// Corrects one body by impulses.
void apply_to(std::uint32_t b, const std::vector<std::unique_ptr<Body>>& bodies, const Delassus& delassus,
              const std::vector<ContactPoint>& contacts, const Vector& impulses) {
  Body& body = *bodies[b];
  if (body.size() == 0) return;
  Rows dv = Rows::Zero(body.size(), 1);
  for (const int i : delassus.of[b].contacts) {
    const ContactPoint& c = contacts[static_cast<std::size_t>(i)];
    const double* const l = &impulses[3 * static_cast<Eigen::Index>(i)];
    const dvec3 impulse = c.axes * dvec3(l[0], l[1], l[2]);
    if (c.body_a == b) body.push(c.a, impulse, dv, 0);
    if (c.body_b == b) body.push(c.b, -impulse, dv, 0);
  }
  if (!delassus.of[b].contacts.empty()) body.solve(dv);
  body.correct(dv);
}

// Contacts for the first stage of the bodies that have one (two_stages.h); then the problem is that of the whole step.
void pass_first_stage(const std::vector<std::unique_ptr<Body>>& bodies, double T, double beta,
                      const SweepLimits& limits, const Delassus& delassus, const std::vector<ContactPoint>& contacts,
                      ContactProblem& problem) {
  bool any = false, touched = false;
  for (std::uint32_t b = 0; b < bodies.size(); ++b)
    if (bodies[b]->staged()) any = true, touched |= !delassus.of[b].contacts.empty();
  if (!any) return;
  if (touched) solve(problem, limits);
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b]->staged()) continue;
    if (!delassus.of[b].contacts.empty()) apply_to(b, bodies, delassus, contacts, problem.impulse);
    bodies[b]->second_stage();
  }
  find_bias(bodies, contacts, T, beta, delassus, problem);
}

// Bodies that are wedged between others cannot all be pushed out of them: no impulses are enough, and they grow with
// every sweep. Then no penetration is undone, and `beta` is 0 from here on: resting is always possible. Not with
// joints or tissue, which yield: grips would sink in.
SweepReport solve_undoing(const std::vector<std::unique_ptr<Body>>& bodies, double T, const SweepLimits& limits,
                          const Delassus& delassus, const std::vector<ContactPoint>& contacts, ContactProblem& problem,
                          double& beta) {
  const SweepReport report = solve(problem, limits);
  const auto is_deep = [](const ContactPoint& c) { return c.depth > 0.0; };
  const auto yields = [&](const ContactPoint& c) {
    return c.hold.joint >= 0 || bodies[c.body_a]->as_tissue() || bodies[c.body_b]->as_tissue();
  };
  if (report.settled || !(beta > 0.0) || std::none_of(contacts.begin(), contacts.end(), is_deep) ||
      std::any_of(contacts.begin(), contacts.end(), yields))
    return report;
  beta = 0.0;
  find_bias(bodies, contacts, T, beta, delassus, problem);
  take_impulses(contacts, problem);
  return solve(problem, limits);
}

// Updates the contacts' laws to their predicted normals and gaps. An end gap was predicted with the velocities of the
// current solution, and changes with a new one.
void look_again(const std::vector<ContactPoint>& contacts, double T, double beta, const Delassus& delassus,
                ContactProblem& problem) {
  problem.own.assign(contacts.size(), dmat3(1.0));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    if (!c.again) continue;
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    const double inside = still_inside(c, i, beta, delassus);
    problem.own[i] = leaning_axes(c.lean);
    const dvec3 normal = problem.own[i][0];
    // Without gaps: velocities of the solution, and without impulses.
    problem.velocity[row] -= (c.gap + inside) / T, problem.bias[row] -= (c.gap + inside) / T;
    const double closing =
        dot(normal, dvec3(problem.velocity[row], problem.velocity[row + 1], problem.velocity[row + 2]));
    const double left = (c.end_gap + inside) / T - closing;
    for (int k = 0; k < 3; ++k) problem.bias[row + k] += left * normal[k];
  }
}

}  // namespace

void build_problem(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                   double T, double beta, Delassus& delassus, ContactProblem& problem) {
  for (const std::unique_ptr<Body>& body : bodies)
    if (body->staged()) body->first_stage();
  problem.resize_vectors(static_cast<int>(contacts.size()));
  delassus.of.resize(bodies.size());
  sort_by_body(contacts, delassus.of);
  split_contacts(bodies, contacts, problem);

  std::vector<PushedSide> sides;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    BodyResponse& response = delassus.of[b];
    if (bodies[b]->size() == 0 || response.contacts.empty()) continue;
    list_sides(b, contacts, response, sides);
    bodies[b]->respond(sides, static_cast<Eigen::Index>(response.contacts.size()), response.compliance);
  }
  find_compliances(bodies, contacts, T, delassus);
  fill_operator(bodies, contacts, delassus, problem);

  find_bias(bodies, contacts, T, beta, delassus, problem);
  const auto is_held = [](const ContactPoint& c) { return c.hold.axes != 0; };
  const auto is_bounded = [](const ContactPoint& c) { return c.hold.most < HUGE_VAL; };
  problem.held.assign(std::any_of(contacts.begin(), contacts.end(), is_held) ? contacts.size() : 0, 0);
  problem.most.assign(std::any_of(contacts.begin(), contacts.end(), is_bounded) ? contacts.size() : 0, HUGE_VAL);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    if (!problem.most.empty()) problem.most[i] = c.hold.most;
    if (c.hold.axes != 0) problem.held[i] = c.hold.axes;
    problem.mu_static[i] = c.mu_static;
    problem.mu_sliding[i] = c.mu_sliding;
  }
  take_impulses(contacts, problem);
  find_patches(bodies, contacts, T, problem);
}

void apply_impulses(const std::vector<std::unique_ptr<Body>>& bodies, const Delassus& delassus,
                    const std::vector<ContactPoint>& contacts, const Vector& impulses) {
  for (std::uint32_t b = 0; b < bodies.size(); ++b) apply_to(b, bodies, delassus, contacts, impulses);
}

void keep_impulses(const ContactProblem& problem, std::vector<ContactPoint>& contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (int k = 0; k < 3; ++k) contacts[i].impulse[k] = problem.impulse[3 * static_cast<Eigen::Index>(i) + k];
    contacts[i].sliding = problem.sliding[i] != 0;
  }
}

SweepReport solve_and_apply(const std::vector<std::unique_ptr<Body>>& bodies, Proximity& proximity, double T,
                            double beta, const SweepLimits& limits, Delassus& delassus,
                            std::vector<ContactPoint>& contacts, ContactProblem& problem, Crossings* left,
                            Joints* joints, bool wedged) {
  problem.own.clear();
  const double free_energy = joints ? joints->kinetic_energy(bodies) : 0.0;
  pass_first_stage(bodies, T, beta, limits, delassus, contacts, problem);
  SweepReport report =
      wedged ? solve_undoing(bodies, T, limits, delassus, contacts, problem, beta) : solve(problem, limits);
  const auto solve_anew = [&] {
    build_problem(bodies, contacts, T, beta, delassus, problem);
    pass_first_stage(bodies, T, beta, limits, delassus, contacts, problem);
    report = solve(problem, limits);
  };
  for (int i = 0; joints && i < kJointRounds && joints->stiffen(bodies, contacts, problem.impulse, T); ++i)
    solve_anew();
  for (int i = 0; joints && i < kJointRounds && joints->snap(problem.impulse, T, contacts); ++i) solve_anew();
  apply_impulses(bodies, delassus, contacts, problem.impulse);
  for (int round = 0;; ++round) {
    keep_impulses(problem, contacts);
    const std::vector<ContactPoint>::size_type known = contacts.size();
    const Crossings missed = proximity.find_missed(bodies, T, contacts);
    const bool last = round == kMostRounds || (round >= kRoundsUnsettled && !report.settled);
    if (last) contacts.resize(known);
    cut_late_contacts(bodies, kMostOfBody, known, contacts);
    if (contacts.size() == known) {
      if (left) *left = missed;
      break;
    }
    Vector applied = Vector::Zero(3 * static_cast<Eigen::Index>(contacts.size()));
    applied.head(3 * static_cast<Eigen::Index>(known)) = problem.impulse.head(3 * static_cast<Eigen::Index>(known));
    solve_anew();
    const Vector whole = problem.impulse.head(applied.size()), more = whole - applied;
    for (std::uint32_t b = 0; b < bodies.size(); ++b)  // a staged body has begun anew
      apply_to(b, bodies, delassus, contacts, bodies[b]->staged() ? whole : more);
  }
  if (proximity.look_again(bodies, T, contacts)) {
    const Vector first = problem.impulse;
    look_again(contacts, T, beta, delassus, problem);
    report = solve(problem, limits);
    apply_impulses(bodies, delassus, contacts, problem.impulse - first);
  }
  keep_impulses(problem, contacts);
  const Vector first = problem.impulse;
  bool bent = false;
  for (int round = 0; round < kTipRoundsOfSolve && linearise_tips(bodies, T, contacts, delassus, problem); ++round) {
    report = solve(problem, limits);
    bent = true;
  }
  if (bent) {
    apply_impulses(bodies, delassus, contacts, problem.impulse - first);
    keep_impulses(problem, contacts);
  }
  const auto again = [&] {
    const Vector before = problem.impulse;
    report = solve(problem, limits);
    apply_impulses(bodies, delassus, contacts, problem.impulse - before);
    keep_impulses(problem, contacts);
  };
  double apart = HUGE_VAL;  // [m] it does not fall where links turn too far in a step
  for (int round = 0; joints && round < kJointRounds; ++round) {
    const double now = joints->look_again(bodies, T, contacts, problem);
    if (now < kJointApart || now > kJointFalls * apart) break;
    apart = now;
    again();
  }
  if (joints && joints->kinetic_energy(bodies) > kJointGains * free_energy) {
    joints->leave_gaps(bodies, contacts, problem);
    again();
  }
  resist_rolling(bodies, contacts, delassus);
  keep_strain(bodies, T, delassus, problem, contacts);
  keep_slip(problem, T, contacts);
  report.left_inside = beta == 0.0;
  return report;
}

}  // namespace pliant
