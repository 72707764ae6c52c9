#include "content/author/object_frame.h"

#include <array>
#include <cmath>
#include <utility>

#include "components/kinematic.h"

namespace pliant {

namespace {

constexpr std::array<std::pair<Side, const char*>, 6> kSides{{{Side::kBottom, "bottom"},
                                                              {Side::kTop, "top"},
                                                              {Side::kLeft, "left"},
                                                              {Side::kRight, "right"},
                                                              {Side::kFront, "front"},
                                                              {Side::kBack, "back"}}};

void add(Box& box, const Level& level, const LevelNode& node, const dmat4& frame) {
  if (node.mesh < 0) return;
  for (const Primitive& primitive : level.meshes[static_cast<std::size_t>(node.mesh)].primitives)
    for (const vec3& p : primitive.position) box.add(vec3(dvec3(frame * glm::dvec4(dvec3(p), 1.0))));
}

}  // namespace

ObjectFrame object_frame(const Level& level, std::int32_t node) {
  const dmat4 world = world_matrices(level.nodes)[static_cast<std::size_t>(node)];
  ObjectFrame out;
  out.pose = rigid_part(world);
  dmat4 pose = glm::mat4_cast(out.pose.rotation);
  pose[3] = glm::dvec4(out.pose.position, 1.0);
  out.to_object = glm::inverse(pose) * world;
  add(out.box, level, level.nodes[static_cast<std::size_t>(node)], out.to_object);
  return out;
}

Box world_box(const Level& level, std::int32_t node) {
  const std::vector<dmat4> world = world_matrices(level.nodes);
  std::vector<bool> below(level.nodes.size(), false);
  Box box;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const std::int32_t parent = level.nodes[i].parent;
    below[i] = static_cast<std::int32_t>(i) == node || (parent >= 0 && below[static_cast<std::size_t>(parent)]);
    if (below[i]) add(box, level, level.nodes[i], world[i]);
  }
  return box;
}

Box world_box(const Level& level) {
  const std::vector<dmat4> world = world_matrices(level.nodes);
  Box box;
  for (std::size_t i = 0; i < level.nodes.size(); ++i)
    if (level.nodes[i].in_scene) add(box, level, level.nodes[i], world[i]);
  return box;
}

dvec3 up_of(const Level& level) {
  const double g = length(level.simulation.gravity);
  return g > 0.0 ? -level.simulation.gravity / g : dvec3(0, 1, 0);
}

LocalTransform looking(dvec3 eye, dvec3 target, dvec3 up) {
  const dvec3 z = normalize(eye - target);
  if (length(cross(up, z)) < 1e-6) up = std::abs(z.x) < 0.9 ? dvec3(1, 0, 0) : dvec3(0, 0, 1);
  const dvec3 x = normalize(cross(up, z));
  return {vec3(eye), quat(glm::normalize(glm::quat_cast(dmat3(x, cross(z, x), z)))), vec3(1)};
}

std::optional<Side> side_of(const std::string& word) {
  for (const auto& [side, name] : kSides)
    if (word == name) return side;
  return {};
}

const char* word_of(Side side) {
  return kSides[static_cast<std::size_t>(side)].second;
}

dvec3 direction_of(const Level& level, Side side) {
  const dvec3 up = up_of(level);
  switch (side) {
    case Side::kBottom:
      return -up;
    case Side::kTop:
      return up;
    case Side::kLeft:
      return {-1, 0, 0};
    case Side::kRight:
      return {1, 0, 0};
    case Side::kFront:
      return {0, 0, 1};
    case Side::kBack:
      return {0, 0, -1};
  }
  return up;
}

}  // namespace pliant
