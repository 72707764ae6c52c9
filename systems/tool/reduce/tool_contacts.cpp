#include "systems/tool/reduce/tool_contacts.h"

#include <algorithm>
#include <tuple>

#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/collide/surface_walk.h"
#include "systems/soft/local/smeared_response.h"

namespace pliant {
namespace {

constexpr std::uint32_t kNotReached = 0xffffffff;

// Distance from the tool, in bodies; immovable bodies transmit nothing.
std::vector<std::uint32_t> distances(const FinishedStep& step, std::uint32_t tool) {
  std::vector<std::uint32_t> distance(step.bodies.size(), kNotReached);
  distance[tool] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (const ContactPoint& c : step.contacts) {
      if (step.bodies[c.body_a]->size() == 0 || step.bodies[c.body_b]->size() == 0) continue;
      std::uint32_t &a = distance[c.body_a], &b = distance[c.body_b];
      if (a != kNotReached && a + 1 < b) b = a + 1, changed = true;
      if (b != kNotReached && b + 1 < a) a = b + 1, changed = true;
    }
  }
  return distance;
}

// [m] An edge of the finer collision mesh: the surface's compliance is not resolved between its vertices.
double farthest(const FinishedStep& step, const ContactPoint& p) {
  return static_cast<double>(
      std::min(step.bodies[p.body_a]->collision_mesh->mean_edge, step.bodies[p.body_b]->collision_mesh->mean_edge));
}

// A P1 surface yields at the contact by its law.
bool yields(const FinishedStep& step, Eigen::Index row) {
  const Eigen::MatrixXd& compliance = step.delassus.compliance;
  return compliance.rows() > row && compliance(row, row) > 0.0;
}

// An open contact whose features separate before the step ends: its plane is no longer valid.
bool passed_by(const FinishedStep& step, std::size_t i) {
  const ContactPoint& p = step.contacts[i];
  return p.hold.joint < 0 && !p.predicted && !(p.impulse.x > 0.0) && p.depth == 0.0 &&
         !yields(step, 3 * static_cast<Eigen::Index>(i));
}

}  // namespace

std::vector<int> contacts_of(const FinishedStep& step, std::uint32_t tool, int most) {
  const std::vector<std::uint32_t> distance = distances(step, tool);
  struct Place {
    std::uint32_t distance;
    double impulse, gap;  // [N s], [m]
    int index;
  };
  std::vector<Place> order;
  for (std::size_t i = 0; i < step.contacts.size(); ++i) {
    const ContactPoint& c = step.contacts[i];
    const std::uint32_t nearest = std::min(distance[c.body_a], distance[c.body_b]);
    if (nearest != kNotReached && !passed_by(step, i))
      order.push_back({nearest, length(c.impulse), c.gap, static_cast<int>(i)});
  }
  // Loaded contacts first, wherever they are: contacts that are left out cannot respond.
  std::stable_sort(order.begin(), order.end(), [](const Place& i, const Place& j) {
    return std::make_tuple(!(i.impulse > 0.0), i.distance, -i.impulse, i.gap) <
           std::make_tuple(!(j.impulse > 0.0), j.distance, -j.impulse, j.gap);
  });
  if (order.size() > static_cast<std::size_t>(most)) order.resize(static_cast<std::size_t>(most));
  std::vector<int> out;
  for (const Place& place : order) out.push_back(place.index);
  return out;
}

bool ToolContacts::chosen(std::size_t in_step) const {
  return std::find(chosen_.begin(), chosen_.end(), static_cast<int>(in_step)) != chosen_.end();
}

bool ToolContacts::takes_part(std::uint32_t body) const {
  bool found = body == tool_;
  for (int i = 0; i < count() && !found; ++i) found = (*this)[i].body_a == body || (*this)[i].body_b == body;
  return found;
}

void ToolContacts::gather(std::uint32_t body, int i, const Rows& x, Eigen::Ref<Rows> out) const {
  const ContactPoint& p = (*this)[i];
  if (p.body_a == body) step_.bodies[body]->gather(p.a, p.axes, 1.0, x, out);
  if (p.body_b == body) step_.bodies[body]->gather(p.b, p.axes, -1.0, x, out);
}

void ToolContacts::gather_slip(std::uint32_t body, int i, int k, const Rows& x, Eigen::Ref<Rows> out) const {
  const ContactPoint& p = (*this)[i];
  const Body& of = *step_.bodies[body];
  const auto add = [&](const SurfacePoint& point, dvec2 way, double sign) {
    const double share = length(way), h = farthest(step_, p);
    if (!(share > 0.0 && h > 0.0)) return;
    const dvec3 by = h / share * (p.axes * dvec3(0.0, way));
    std::optional<SurfacePoint> ahead = walk(of, point, by), back = walk(of, point, -by);
    if (!ahead || !back) return;
    if (point.smeared)
      for (SurfacePoint* const walked : {&*ahead, &*back})
        smear_again(*of.as_tissue()->smearing(), *of.collision_mesh, *walked);
    of.gather(*ahead, p.axes, sign * share / (2.0 * h), x, out);
    of.gather(*back, p.axes, -sign * share / (2.0 * h), x, out);
  };
  if (p.body_a == body) add(p.a, p.over_a[k], 1.0);
  if (p.body_b == body) add(p.b, p.over_b[k], -1.0);
}

void set_solution(const ToolContacts& contacts, int i, dvec3 impulse, dvec3 velocity, CondensedContacts& out) {
  const FinishedStep& step = contacts.step();
  const ContactPoint& p = contacts[i];
  for (int k = 0; k < 3; ++k) out.force[3 * i + k] = impulse[k] / step.T;
  // Remaining gap T u; for a penetration, minus the part that is not corrected.
  const bool inside = p.depth > 0.0 && !yields(step, 3 * contacts.in_step(i));
  double left = step.T * dot(leaning_axes(p.lean)[0], velocity);
  if (inside) left -= (1.0 - step.beta) * p.depth;
  if ((impulse.x > 0.0 && !inside) || p.hold.axes != 0) left = 0.0;
  out.gap[i] = left;
  out.push[i] = std::min(0.0, step.beta * left / step.T);
}

void describe_contacts(const ToolContacts& contacts, CondensedContacts& out) {
  const FinishedStep& step = contacts.step();
  const Eigen::MatrixXd& compliance = step.delassus.compliance;
  out.count = contacts.count();
  out.from_handle.topRows(contacts.rows()).setZero();
  out.flexibility.topLeftCorner(contacts.rows(), contacts.rows()).setZero();
  Rows three(3, 6);
  for (int i = 0; i < out.count; ++i) {
    const ContactPoint& p = contacts[i];
    const int row = 3 * contacts.in_step(i);
    three.setZero();
    contacts.gather(contacts.tool_index(), i, contacts.tool().follow(), three);
    out.from_handle.middleRows(3 * i, 3) = three;
    for (int k = 0; k < 2; ++k) {
      three.setZero();
      contacts.gather_slip(contacts.tool_index(), i, k, contacts.tool().follow(), three);
      out.from_handle_by_slip[k].middleRows(3 * i, 3) = three;
    }

    const double* const u = &step.problem.velocity[row];
    set_solution(contacts, i, p.impulse, dvec3(u[0], u[1], u[2]), out);

    out.mu_static[static_cast<std::size_t>(i)] = p.mu_static;
    out.mu_sliding[static_cast<std::size_t>(i)] = p.mu_sliding;
    out.sliding[static_cast<std::size_t>(i)] = p.sliding;
    out.held[static_cast<std::size_t>(i)] = p.hold.axes;
    out.most[static_cast<std::size_t>(i)] = p.hold.most / step.T;
    out.unbounded[static_cast<std::size_t>(i)] =
        p.hold.most < HUGE_VAL ? (p.impulse.x - u[0] / p.hold.softness.x) / step.T : 0.0;
    const auto prescribed = [&](std::uint32_t b, const SurfacePoint& at) {
      const Body& body = *step.bodies[b];
      return body.prescribed() ? body.velocity_of(at) * p.axes : dvec3(0.0);
    };
    const dvec3 drift = prescribed(p.body_a, p.a) - prescribed(p.body_b, p.b);
    for (int k = 0; k < 3; ++k) out.drift[3 * i + k] = drift[k];
    out.lean[static_cast<std::size_t>(i)] = p.lean;
    out.turning[static_cast<std::size_t>(i)] = p.turning;
    out.slip[static_cast<std::size_t>(i)] = dvec2(0.0);
    out.key[static_cast<std::size_t>(i)] = p.key;
    out.farthest[static_cast<std::size_t>(i)] = farthest(step, p);
    out.reach[static_cast<std::size_t>(i)] = p.reach;
    for (int j = 0; yields(step, row) && j < out.count; ++j)
      out.flexibility.block<3, 3>(3 * i, 3 * j) =
          step.T * step.T * compliance.block<3, 3>(row, 3 * contacts.in_step(j));
  }
}

}  // namespace pliant
