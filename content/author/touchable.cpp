#include "content/author/touchable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/keys/stated.h"

namespace pliant {

namespace {

constexpr double kBeyond = 0.02;  // [1] of the extent: margin of a pinned box, so that rounding excludes no surface
                                  // node

Status check_area(const Level& level, std::int32_t node) {
  const LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  if (it.mesh < 0) return Error{it.name, "has no mesh", "choose a node that shows one"};
  const dmat3 frame(world_matrices(level.nodes)[static_cast<std::size_t>(node)]);
  if (!has_area(level.meshes[static_cast<std::size_t>(it.mesh)], frame))
    return Error{it.name, "has a mesh without area", "choose another node"};
  return Done{};
}

}  // namespace

Status make_touchable_surface(Level& level, std::int32_t node, const DeformableParameters& parameters) {
  if (const Status status = check_area(level, node); !status) return status;
  LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  it.soft_body.reset();
  it.rigid_body.reset();
  it.handle.reset();
  for (const char* gone : {"soft_body", "rigid_body", "handle", "deformable"}) forget_stated(it.stated, gone);
  it.deformable = Deformable{};
  static_cast<DeformableParameters&>(*it.deformable) = parameters;
  return Done{};
}

Status make_soft(Level& level, std::int32_t node, const SoftBodyParameters& parameters) {
  if (const Status status = check_area(level, node); !status) return status;
  LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  it.deformable.reset();
  it.rigid_body.reset();
  for (const char* gone : {"deformable", "rigid_body", "soft_body"}) forget_stated(it.stated, gone);
  it.soft_body = SoftBody{};
  static_cast<SoftBodyParameters&>(*it.soft_body) = parameters;
  return Done{};
}

Status pin(Level& level, std::int32_t node, Side side, double share) {
  LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  if (!it.soft_body) return Error{it.name, "has no soft body to pin", "make it soft first"};
  if (!(share > 0.0 && share <= 1.0))
    return Error{it.name, fmt::format("cannot be pinned by a share of {:g}", share), "use more than 0, at most 1"};
  const ObjectFrame frame = object_frame(level, node);
  const dvec3 direction = glm::conjugate(frame.pose.rotation) * direction_of(level, side);
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(direction[i]) > std::abs(direction[axis])) axis = i;
  const vec3 size = frame.box.size(), margin = static_cast<float>(kBeyond) * vec3(std::max({size.x, size.y, size.z}));
  Box box{frame.box.min - margin, frame.box.max + margin};
  const float depth = static_cast<float>(share) * size[axis];
  if (direction[axis] > 0.0)
    box.min[axis] = frame.box.max[axis] - depth;
  else
    box.max[axis] = frame.box.min[axis] + depth;
  Box both = it.soft_body->pinned;
  both.add(box.min);
  both.add(box.max);
  const auto same = [&](const Box& other) { return both.min == other.min && both.max == other.max; };
  if (it.soft_body->pinned.empty() || same(box) || same(it.soft_body->pinned)) {
    it.soft_body->pinned = both;
    return Done{};
  }
  // One box around two sides would hold what is between them, too: the other side is painted.
  if (it.mesh < 0) return Error{it.name, "has no mesh on which a second side could be painted as pinned"};
  LevelMesh& mesh = own_mesh(level, node);
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
    std::vector<std::uint32_t> inside;
    for (std::size_t v = 0; v < mesh.primitives[p].position.size(); ++v) {
      const vec3 at(frame.to_object * glm::dvec4(dvec3(mesh.primitives[p].position[v]), 1.0));
      if (glm::all(glm::greaterThanEqual(at, box.min)) && glm::all(glm::lessThanEqual(at, box.max)))
        inside.push_back(static_cast<std::uint32_t>(v));
    }
    if (inside.empty()) continue;
    if (const Status painted = pin_vertices(level, node, p, inside); !painted) return painted;
  }
  return Done{};
}

void unpin(Level& level, std::int32_t node) {
  LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  if (it.soft_body) it.soft_body->pinned = {};
  if (it.mesh < 0) return;
  for (Primitive& primitive : own_mesh(level, node).primitives) primitive.pinned.clear();
}

LevelMesh& own_mesh(Level& level, std::int32_t node) {
  LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  const bool shared = std::count_if(level.nodes.begin(), level.nodes.end(),
                                    [&](const LevelNode& other) { return other.mesh == it.mesh; }) > 1;
  if (shared) {
    level.meshes.push_back(LevelMesh(level.meshes[static_cast<std::size_t>(it.mesh)]));
    it.mesh = static_cast<std::int32_t>(level.meshes.size()) - 1;
  }
  return level.meshes[static_cast<std::size_t>(it.mesh)];
}

Status pin_vertices(Level& level, std::int32_t node, std::size_t primitive, std::span<const std::uint32_t> vertices,
                    float value) {
  const LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  if (it.mesh < 0 || primitive >= level.meshes[static_cast<std::size_t>(it.mesh)].primitives.size())
    return Error{it.name, fmt::format("has no primitive {} to pin", primitive)};
  if (!(value >= 0.0f && value <= 1.0f))
    return Error{it.name, fmt::format("cannot be pinned by {:g}", value), "use 0 to 1"};
  Primitive& to = own_mesh(level, node).primitives[primitive];
  for (const std::uint32_t vertex : vertices)
    if (vertex >= to.position.size())
      return Error{it.name, fmt::format("has no vertex {}", vertex),
                   fmt::format("the last one is {}", to.position.size() - 1)};
  if (to.pinned.empty()) to.pinned.assign(to.position.size(), 0.0f);
  for (const std::uint32_t vertex : vertices) to.pinned[vertex] = value;
  return Done{};
}

}  // namespace pliant
