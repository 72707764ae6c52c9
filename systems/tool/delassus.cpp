#include "systems/tool/delassus.h"

namespace pliant {
namespace {

constexpr int kMostRounds = 8;  // in which contacts that a solution brings about join; a round reaches one body further

// The contacts of each body.
void sort_by_body(const std::vector<ContactPoint>& contacts, std::vector<BodyResponse>& of) {
  for (BodyResponse& response : of) response.contacts.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    of[c.body_a].contacts.push_back(static_cast<int>(i));
    if (c.body_b != c.body_a) of[c.body_b].contacts.push_back(static_cast<int>(i));
  }
}

// Its sides of its contacts. Side a feels +lambda, side b -lambda; of a self-contact both are this body's.
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

// W += J A^-1 J^T, the lower triangle only: contacts are in ascending order and the mirror image is the same.
void add_response(const BodyResponse& response, Eigen::MatrixXd& w) {
  const Rows& lever = response.compliance.lever;
  const auto count = static_cast<Eigen::Index>(response.contacts.size());
  for (Eigen::Index k = 0; k < count; ++k)
    for (Eigen::Index m = 0; m <= k; ++m) {
      const int i = response.contacts[static_cast<std::size_t>(k)], j = response.contacts[static_cast<std::size_t>(m)];
      auto block = w.block<3, 3>(3 * i, 3 * j);
      block += response.compliance.held.block<3, 3>(3 * k, 3 * m);
      if (lever.cols() > 0)
        block += lever.middleRows<3>(3 * k).leftCols<6>() * lever.middleRows<3>(3 * m).leftCols<6>().transpose();
    }
}

void add_compliances(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                     double T, Delassus& delassus) {
  delassus.compliance.setZero(3 * static_cast<Eigen::Index>(contacts.size()),
                              3 * static_cast<Eigen::Index>(contacts.size()));
  std::vector<Body::Side> sides;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    sides.clear();
    for (const int i : delassus.of[b].contacts) {
      const ContactPoint& c = contacts[static_cast<std::size_t>(i)];
      sides.push_back({i, c.body_a == b ? &c.a : &c.b});
    }
    if (!sides.empty()) bodies[b]->add_compliance(sides, T, delassus.compliance);
  }
}

// [m/s] J v* of one side: the skin is interpolated linearly by every body.
dvec3 free_velocity(const Body& body, const SurfacePoint& point) {
  const uvec3 t = body.skin->triangles[point.triangle];
  return point.barycentric.x * body.skin_velocity[t.x] + point.barycentric.y * body.skin_velocity[t.y] +
         point.barycentric.z * body.skin_velocity[t.z];
}

// [m] How much less than its gap a contact is to close: what of a penetration this step does not undo, if nothing
// yields.
double still_inside(const ContactPoint& c, std::size_t i, double beta, const Delassus& delassus) {
  const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
  return delassus.compliance(row, row) > 0.0 ? 0.0 : (1.0 - beta) * c.depth;
}

// The contacts' laws become those of the normals and gaps that they will have. An end gap was foretold with the
// velocities of the solution that there is, and changes with what a new one does to them.
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
    // Of the velocities alone, those of the solution and those without impulses.
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
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(contacts.size());
  problem.resize(static_cast<int>(contacts.size()));
  problem.W.topLeftCorner(rows, rows).setZero();
  delassus.of.resize(bodies.size());
  sort_by_body(contacts, delassus.of);

  std::vector<PushedSide> sides;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    BodyResponse& response = delassus.of[b];
    if (bodies[b]->size() == 0 || response.contacts.empty()) continue;
    list_sides(b, contacts, response, sides);
    bodies[b]->respond(sides, static_cast<Eigen::Index>(response.contacts.size()), response.compliance);
    add_response(response, problem.W);
  }
  add_compliances(bodies, contacts, T, delassus);
  auto w = problem.W.topLeftCorner(rows, rows);
  w += delassus.compliance;
  w.triangularView<Eigen::StrictlyUpper>() = w.transpose();

  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    const dvec3 u = free_velocity(*bodies[c.body_a], c.a) - free_velocity(*bodies[c.body_b], c.b);
    for (int k = 0; k < 3; ++k) {
      problem.bias[row + k] = dot(c.axes[k], u);
      problem.impulse[row + k] = c.impulse[k];
    }
    problem.bias[row] += (c.gap + still_inside(c, i, beta, delassus)) / T;
    problem.mu_static[i] = c.mu_static;
    problem.mu_sliding[i] = c.mu_sliding;
    problem.sliding[i] = c.sliding;
  }
}

void apply_impulses(const std::vector<std::unique_ptr<Body>>& bodies, const Delassus& delassus,
                    const std::vector<ContactPoint>& contacts, const Vector& impulses) {
  Rows dv;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b]->size() == 0) continue;
    dv.setZero(bodies[b]->size(), 1);
    for (const int i : delassus.of[b].contacts) {
      const ContactPoint& c = contacts[static_cast<std::size_t>(i)];
      const double* const l = &impulses[3 * static_cast<Eigen::Index>(i)];
      const dvec3 impulse = c.axes * dvec3(l[0], l[1], l[2]);
      if (c.body_a == b) bodies[b]->push(c.a, impulse, dv, 0);
      if (c.body_b == b) bodies[b]->push(c.b, -impulse, dv, 0);
    }
    if (!delassus.of[b].contacts.empty()) bodies[b]->solve(dv);
    bodies[b]->correct(dv);
  }
}

void keep_impulses(const ContactProblem& problem, std::vector<ContactPoint>& contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (int k = 0; k < 3; ++k) contacts[i].impulse[k] = problem.impulse[3 * static_cast<Eigen::Index>(i) + k];
    contacts[i].sliding = problem.sliding[i] != 0;
  }
}

SweepReport solve_and_apply(const std::vector<std::unique_ptr<Body>>& bodies, Proximity& proximity, double T,
                            double beta, const SweepLimits& limits, Delassus& delassus,
                            std::vector<ContactPoint>& contacts, ContactProblem& problem, std::uint64_t* crossed) {
  problem.own.clear();
  SweepReport report = solve(problem, limits);
  apply_impulses(bodies, delassus, contacts, problem.impulse);
  for (int round = 0;; ++round) {
    keep_impulses(problem, contacts);
    const std::vector<ContactPoint>::size_type known = contacts.size();
    const std::size_t missed = proximity.find_missed(bodies, T, contacts);
    if (round == kMostRounds && crossed) *crossed += missed;
    if (round == kMostRounds) contacts.resize(known);
    if (contacts.size() == known) break;
    Vector applied = Vector::Zero(3 * static_cast<Eigen::Index>(contacts.size()));
    applied.head(3 * static_cast<Eigen::Index>(known)) = problem.impulse.head(3 * static_cast<Eigen::Index>(known));
    build_problem(bodies, contacts, T, beta, delassus, problem);
    report = solve(problem, limits);
    apply_impulses(bodies, delassus, contacts, problem.impulse.head(applied.size()) - applied);
  }
  if (proximity.look_again(bodies, T, contacts)) {
    const Vector first = problem.impulse;
    look_again(contacts, T, beta, delassus, problem);
    report = solve(problem, limits);
    apply_impulses(bodies, delassus, contacts, problem.impulse - first);
  }
  keep_impulses(problem, contacts);
  return report;
}

}  // namespace pliant
