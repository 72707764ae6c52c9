#include "systems/tool/pull.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/soft/soft_state.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

const dmat3 kWorldAxes(1.0);

Eigen::Vector3d eigen_of(dvec3 v) {
  return {v.x, v.y, v.z};
}

dvec3 at_point(const Body& body, const SurfacePoint& point) {
  const uvec3 t = body.collision_mesh->triangles[point.triangle];
  return point.barycentric.x * body.surface_position[t.x] + point.barycentric.y * body.surface_position[t.y] +
         point.barycentric.z * body.surface_position[t.z];
}

dvec3 outward_of(const Body& body, std::uint32_t triangle) {
  const uvec3 t = body.collision_mesh->triangles[triangle];
  const dvec3 n = cross(body.surface_position[t.y] - body.surface_position[t.x],
                        body.surface_position[t.z] - body.surface_position[t.x]);
  const double size = length(n);
  return size > 0.0 ? n / size : dvec3(0);
}

struct TriangleFoot {
  dvec3 barycentric, point;
};

// The point of a triangle that is nearest to p: inside, or on the nearest edge.
TriangleFoot foot_on_triangle(dvec3 p, dvec3 a, dvec3 b, dvec3 c) {
  const dvec3 n = cross(b - a, c - a);
  const double nn = dot(n, n);
  if (nn > 0.0) {
    const double u = dot(cross(b - p, c - p), n) / nn, v = dot(cross(c - p, a - p), n) / nn, w = 1.0 - u - v;
    if (u >= 0.0 && v >= 0.0 && w >= 0.0) return {{u, v, w}, u * a + v * b + w * c};
  }
  const dvec3 corner[3] = {a, b, c};
  TriangleFoot best{{1, 0, 0}, a};
  for (int i = 0; i < 3; ++i) {
    const dvec3 from = corner[i], edge = corner[(i + 1) % 3] - from;
    const double ee = dot(edge, edge), s = ee > 0.0 ? std::clamp(dot(p - from, edge) / ee, 0.0, 1.0) : 0.0;
    TriangleFoot on{dvec3(0), from + s * edge};
    on.barycentric[i] = 1.0 - s;
    on.barycentric[(i + 1) % 3] += s;
    if (length(on.point - p) < length(best.point - p)) best = on;
  }
  return best;
}

// Rigid body: the point. Soft body: the surface around it that faces the same way.
void take_hold(const Body& body, dvec3 at, Pull& pull) {
  pull.parts.clear();
  if (body.collision_mesh->triangles.empty()) return;
  const SurfacePoint middle = nearest_on(body, at);
  pull.parts.push_back({middle, 1.0});
  const double radius = kPullPatch * static_cast<double>(body.collision_mesh->box.diagonal());
  if (body.size() == 6) return;
  const dvec3 outward = outward_of(body, middle.triangle);
  double sum = 1.0;
  for (std::uint32_t i = 0; i < body.collision_mesh->triangles.size(); ++i) {
    const SurfacePoint point{i, dvec3(1.0 / 3.0), at_point(body, {i, dvec3(1.0 / 3.0), {}})};
    const double share = length(point.position - middle.position) / radius;
    if (!(share < 1.0) || !(dot(outward_of(body, i), outward) > 0.5)) continue;
    const double weight = (1.0 - share * share) * (1.0 - share * share);
    pull.parts.push_back({point, weight});
    sum += weight;
  }
  for (Pull::Part& part : pull.parts) part.weight /= sum;
}

// The body of this pull; null without one.
Body* pulled_body(SoftState& soft, const ProbeHold& hold, Pull& pull) {
  if (hold.body == kNoEntity) {
    pull = {};
    return nullptr;
  }
  if (pull.number != hold.number) {
    pull = {};
    pull.number = hold.number;
    for (std::uint32_t i = 0; i < soft.bodies.size(); ++i)
      if (soft.bodies[i]->entity == hold.body && soft.bodies[i]->size() > 0) {
        pull.body = i;
        take_hold(*soft.bodies[i], hold.point, pull);
      }
  }
  if (pull.parts.empty()) return nullptr;
  Body* const body = soft.bodies[pull.body].get();
  return body->solvable() && !body->absent ? body : nullptr;
}

struct Patch {
  dvec3 position{0}, velocity{0};                        // [m], [m/s] world, without the pull
  Eigen::Matrix3d compliance = Eigen::Matrix3d::Zero();  // [1/kg] W
  Rows moved;                                            // A^-1 J^T
};

Patch patch_of(Body& body, Pull& pull) {
  Patch out;
  out.moved = Rows::Zero(body.size(), 3);
  Rows velocity(body.size(), 1), held = Rows::Zero(3, 1), response = Rows::Zero(3, 3);
  velocity.col(0) = body.velocity();
  for (Pull::Part& part : pull.parts) {
    part.point.position = at_point(body, part.point);
    out.position += part.weight * part.point.position;
    body.spread(part.point, kWorldAxes, part.weight, out.moved, 0);
    body.gather(part.point, kWorldAxes, part.weight, velocity, held);
  }
  body.solve(out.moved);
  for (const Pull::Part& part : pull.parts) body.gather(part.point, kWorldAxes, part.weight, out.moved, response);
  out.velocity = {held(0, 0), held(1, 0), held(2, 0)};
  out.compliance = response;
  return out;
}

// [N s] lambda.
Eigen::Vector3d impulse_of(const Patch& patch, const RigidMotion& device, const Handle6& settings, double share,
                           double most, double T) {
  const dvec3 stretch = device.pose.position - patch.position;
  const double force = length(stretch) * share * settings.translation[0];
  const double secant = force > 0.0 ? length(pull_force(stretch, share * settings.translation[0], most)) / force : 1.0;
  const double k = secant * share * settings.translation[0], b = share * settings.translation[1];
  const Eigen::Vector3d wanted =
      T * eigen_of(k * (stretch - T * patch.velocity) + b * (linear(device.velocity) - patch.velocity));
  const Eigen::Matrix3d held = Eigen::Matrix3d::Identity() + (T * b + T * T * k) * patch.compliance;
  const Eigen::Vector3d lambda = held.partialPivLu().solve(wanted);
  const double size = lambda.norm();
  return size > T * most ? Eigen::Vector3d(lambda * (T * most / size)) : lambda;
}

void pull_body(ToolTouchState& tool, const ToolInput& input, Body& body, double T) {
  Pull& pull = tool.pull;
  const double share = std::min(1.0, pull.held_for / kPullComesIn);
  const Patch patch = patch_of(body, pull);
  const Eigen::Vector3d lambda = impulse_of(patch, input.device, tool.settings, share, input.max_force, T);
  if (!lambda.allFinite()) return;
  body.correct(patch.moved * lambda);
  body.move_surface(body.surface_velocity);
  const Eigen::Vector3d gained = patch.compliance * lambda;
  tool.pending.pull = {pull.number, input.time, patch.position,
                       patch.velocity + dvec3(gained.x(), gained.y(), gained.z()), share};
  pull.held_for += T;
}

}  // namespace

SurfacePoint nearest_on(const Body& body, dvec3 p) {
  SurfacePoint best;
  double least = std::numeric_limits<double>::max();
  for (std::uint32_t i = 0; i < body.collision_mesh->triangles.size(); ++i) {
    const uvec3 t = body.collision_mesh->triangles[i];
    const dvec3 a = body.surface_position[t.x], b = body.surface_position[t.y], c = body.surface_position[t.z];
    const TriangleFoot found = foot_on_triangle(p, a, b, c);
    const double away = length(found.point - p);
    if (!(away < least)) continue;
    least = away;
    best = {i, found.barycentric, found.point};
  }
  return best;
}

dvec3 pull_force(dvec3 stretch, double stiffness, double most) {
  const double force = stiffness * length(stretch);
  if (!(force > 0.0) || !(most > 0.0)) return dvec3(0);
  return stretch * (stiffness * most * std::tanh(force / most) / force);
}

void pull_bodies(World& world, Tick tick) {
  if (!world.soft || !world.tools) return;
  SoftState& soft = *world.soft;
  for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools) {
    if (!tool->is_probe) continue;
    const ToolInput& input = tool->input.read();
    tool->pending.pull = {};
    Body* const body = pulled_body(soft, input.hold, tool->pull);
    if (body && input.status == DeviceStatus::kReady) pull_body(*tool, input, *body, tick.dt);
  }
}

}  // namespace pliant
