#include "editor/tools/surface_under.h"

#include <algorithm>
#include <cmath>

#include "editor/viewport/frames.h"

namespace pliant {
namespace {

bool meets(const ViewRay& ray, const Box& box) {
  const double slack = 1e-3 * static_cast<double>(box.diagonal());
  double from = 0, to = 1e300;
  for (int i = 0; i < 3; ++i) {
    const double low = static_cast<double>(box.min[i]) - slack, high = static_cast<double>(box.max[i]) + slack;
    if (std::abs(ray.along[i]) < 1e-300) {
      if (ray.from[i] < low || ray.from[i] > high) return false;
      continue;
    }
    const double a = (low - ray.from[i]) / ray.along[i], b = (high - ray.from[i]) / ray.along[i];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

}  // namespace

SurfaceUnder surface_under(Editor& editor, const ViewRay& ray, std::span<const NodeId> without) {
  const State& state = editor.state();
  const std::vector<dmat4> frames = world_frames(state);
  const std::vector<bool> shown = shown_nodes(state, editor.view.isolated), held = at_or_below(state, without);
  SurfaceUnder out;
  double nearest = 1e300;
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    const DocumentNode& node = *state.nodes[i];
    if (!shown[i] || held[i] || node.node.mesh < 0) continue;
    const Box box = bounds_of(state, i, frames[i]);
    if (box.empty() || !meets(ray, box)) continue;
    const auto surface = editor.surface_of(node.id);
    if (!surface) {
      out.waits = out.waits || !editor.jobs.idle();
      continue;
    }
    const dvec3 place(frames[i][3]);
    const SurfaceHit hit = surface->hit({ray.from - place, ray.along}, true);
    if (!hit.valid()) continue;
    const double away = dot(hit.point + place - ray.from, ray.along);
    if (away >= nearest) continue;
    nearest = away;
    out.point = hit.point + place;
    out.normal = hit.normal;
    out.node = node.id;
  }
  return out;
}

std::optional<dvec3> lowest_point(const State& state, std::span<const NodeId> ids) {
  const std::vector<dmat4> frames = world_frames(state);
  const std::vector<bool> held = at_or_below(state, ids);
  std::optional<dvec3> lowest;
  const auto offer = [&](const dvec3& p) {
    if (!lowest || p.y < lowest->y) lowest = p;
  };
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    if (!held[i]) continue;
    const LevelNode& node = state.nodes[i]->node;
    if (node.probe) offer(dvec3(frames[i][3]) - dvec3(0, node.probe->radius, 0));
    if (node.mesh < 0) continue;
    const mat4 frame(frames[i]);
    for (const Primitive& primitive : state.meshes[static_cast<std::size_t>(node.mesh)]->primitives)
      for (const vec3& p : primitive.position) offer(dvec3(vec3(frame * vec4(p, 1.0f))));
  }
  return lowest;
}

}  // namespace pliant
