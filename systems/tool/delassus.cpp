#include "systems/tool/delassus.h"

namespace pliant {
namespace {

// The contacts of each body.
void sort_by_body(const std::vector<ContactPoint>& contacts, std::vector<BodyResponse>& of) {
  for (BodyResponse& response : of) response.contacts.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    of[c.body_a].contacts.push_back(static_cast<int>(i));
    if (c.body_b != c.body_a) of[c.body_b].contacts.push_back(static_cast<int>(i));
  }
}

// z = A^-1 J^T. Side a feels +lambda, side b -lambda; of a self-contact both are this body's.
void respond(const Body& body, std::uint32_t index, const std::vector<ContactPoint>& contacts, BodyResponse& response) {
  response.z.setZero(body.size(), 3 * static_cast<Eigen::Index>(response.contacts.size()));
  int first = 0;
  for (const int i : response.contacts) {
    const ContactPoint& c = contacts[static_cast<std::size_t>(i)];
    if (c.body_a == index) body.spread(c.a, c.axes, 1.0, response.z, first);
    if (c.body_b == index) body.spread(c.b, c.axes, -1.0, response.z, first);
    first += 3;
  }
  body.solve(response.z);
}

// W += J z, the lower triangle only: contacts are in ascending order and the mirror image is the same.
void add_response(const Body& body, std::uint32_t index, const std::vector<ContactPoint>& contacts,
                  const BodyResponse& response, Rows& rows, Eigen::MatrixXd& w) {
  const std::size_t count = response.contacts.size();
  for (std::size_t k = 0; k < count; ++k) {
    const int i = response.contacts[k];
    const ContactPoint& c = contacts[static_cast<std::size_t>(i)];
    rows.setZero(3, 3 * static_cast<Eigen::Index>(count));
    if (c.body_a == index) body.gather(c.a, c.axes, 1.0, response.z, rows);
    if (c.body_b == index) body.gather(c.b, c.axes, -1.0, response.z, rows);
    for (std::size_t m = 0; m <= k; ++m)
      w.block<3, 3>(3 * i, 3 * response.contacts[m]) += rows.middleCols<3>(3 * static_cast<Eigen::Index>(m));
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

}  // namespace

void build_problem(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                   double T, double beta, Delassus& delassus, ContactProblem& problem) {
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(contacts.size());
  problem.resize(static_cast<int>(contacts.size()));
  problem.W.topLeftCorner(rows, rows).setZero();
  delassus.of.resize(bodies.size());
  sort_by_body(contacts, delassus.of);

  Rows gathered;
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b]->size() == 0 || delassus.of[b].contacts.empty()) continue;
    respond(*bodies[b], b, contacts, delassus.of[b]);
    add_response(*bodies[b], b, contacts, delassus.of[b], gathered, problem.W);
  }
  add_compliances(bodies, contacts, T, delassus);
  auto w = problem.W.topLeftCorner(rows, rows);
  w += delassus.compliance;
  w.triangularView<Eigen::StrictlyUpper>() = w.transpose();

  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactPoint& c = contacts[i];
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
    const dvec3 u = free_velocity(*bodies[c.body_a], c.a) - free_velocity(*bodies[c.body_b], c.b);
    const bool yields = delassus.compliance(row, row) > 0.0;
    for (int k = 0; k < 3; ++k) {
      problem.bias[row + k] = dot(c.axes[k], u);
      problem.impulse[row + k] = c.impulse[k];
    }
    problem.bias[row] += (c.gap + (yields ? 0.0 : (1.0 - beta) * c.depth)) / T;
    problem.mu_static[i] = c.mu_static;
    problem.mu_sliding[i] = c.mu_sliding;
    problem.sliding[i] = c.sliding;
  }
}

void apply_impulses(const std::vector<std::unique_ptr<Body>>& bodies, const Delassus& delassus,
                    const ContactProblem& problem, std::vector<ContactPoint>& contacts) {
  Vector lambda, dv;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const BodyResponse& response = delassus.of[b];
    if (bodies[b]->size() == 0) continue;
    dv.setZero(bodies[b]->size());
    if (!response.contacts.empty()) {
      lambda.resize(3 * static_cast<Eigen::Index>(response.contacts.size()));
      Eigen::Index row = 0;
      for (const int i : response.contacts) {
        lambda.segment<3>(row) = problem.impulse.segment<3>(3 * i);
        row += 3;
      }
      dv.noalias() = response.z * lambda;
    }
    bodies[b]->correct(dv);
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (int k = 0; k < 3; ++k) contacts[i].impulse[k] = problem.impulse[3 * static_cast<Eigen::Index>(i) + k];
    contacts[i].sliding = problem.sliding[i] != 0;
  }
}

}  // namespace pliant
