#include "systems/tool/begun_inside.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/tool/pull.h"

namespace pliant {
namespace {

// [1] of the smaller diagonal: a tool of a level may lie on a body, and then touches it from the beginning.
constexpr double kSunkIn = 0.01;

// How often a body's surface winds around a point: 1 inside of a closed one, 0 outside (van Oosterom & Strackee 1983).
double winding(const Body& body, dvec3 x) {
  double angle = 0.0;
  for (const uvec3 t : body.collision_mesh->triangles) {
    const dvec3 a = body.surface_position[t.x] - x, b = body.surface_position[t.y] - x,
                c = body.surface_position[t.z] - x;
    const double la = length(a), lb = length(b), lc = length(c);
    angle += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return angle / (2 * std::numbers::pi);
}

// [m] Depth of a sphere in a body; < 0: apart.
double depth_of(dvec3 centre, double radius, const Body& in) {
  const double away = length(nearest_on(in, centre).position - centre);
  return winding(in, centre) < 0.5 ? radius - away : radius + away;
}

// [m] Depth of a tool in a body, or the first one beyond `enough`; < 0: apart.
double depth_in(const Body& tool, const Body& in, double enough) {
  dvec3 low(HUGE_VAL), high(-HUGE_VAL);
  for (const dvec3& p : in.surface_position) low = glm::min(low, p), high = glm::max(high, p);
  double deepest = -HUGE_VAL;
  const auto add = [&](dvec3 centre, double radius) {
    const bool far = glm::any(glm::lessThan(centre + radius, low)) || glm::any(glm::greaterThan(centre - radius, high));
    if (!far && deepest <= enough) deepest = std::max(deepest, depth_of(centre, radius, in));
  };
  for (const SphereTip& tip : tool.tips) add(tool.pose_after(0.0)->to_world(tip.centre), tip.radius);
  if (tool.tips.empty())
    for (const dvec3& p : tool.surface_position) add(p, 0.0);
  return deepest;
}

double size_of(const Body& body) {
  return static_cast<double>(body.collision_mesh->box.diagonal());
}

bool may_be_in(const Body& tool, const Body& body) {
  const bool apart = &tool == &body || body.kind != BodyKind::kBody || body.absent || body.taken_out ||
                     std::find(tool.joined.begin(), tool.joined.end(), &body) != tool.joined.end();
  return !apart && body.collision_mesh->closed;
}

}  // namespace

bool begins_inside(SoftState& soft, std::size_t index) {
  const Body& tool = *soft.bodies[index];
  if (!tool.pose_after(0.0)) return false;
  bool inside = false;
  for (std::size_t i = 0; i < soft.bodies.size(); ++i) {
    const Body& body = *soft.bodies[i];
    const bool rigid = begins_without_contact(tool, body);
    if (!may_be_in(tool, body) || !(rigid || tool.kind == BodyKind::kProbe)) continue;
    const double depth = depth_in(tool, body, HUGE_VAL);
    if (rigid && !(depth > kSunkIn * std::min(size_of(tool), size_of(body)))) continue;
    inside = inside || rigid;
    if (depth <= soft.tally.began_inside) continue;
    soft.tally.began_inside = depth;
    soft.tally.inside_a = static_cast<std::uint32_t>(index), soft.tally.inside_b = static_cast<std::uint32_t>(i);
  }
  return inside;
}

bool still_inside(const SoftState& soft, std::size_t index) {
  const Body& tool = *soft.bodies[index];
  return std::any_of(soft.bodies.begin(), soft.bodies.end(), [&](const std::unique_ptr<Body>& body) {
    return begins_without_contact(tool, *body) && may_be_in(tool, *body) && depth_in(tool, *body, 0.0) > 0.0;
  });
}

}  // namespace pliant
