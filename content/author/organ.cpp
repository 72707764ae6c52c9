#include "content/author/organ.h"

#include <algorithm>

#include "content/level/carried_parts.h"
#include "content/mesh/mesh_build.h"

namespace pliant {
namespace {

std::vector<std::int32_t> nested_in(const Level& level, std::int32_t node) {
  const LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  const ObjectFrame frame = object_frame(level, node);
  const LevelMesh& mesh = level.meshes[static_cast<std::size_t>(it.mesh)];
  const Result<BuiltMesh> built = build_mesh(it.name, mesh.primitives, mat4(frame.to_object));
  if (!built) return {};
  const dmat4 world = world_matrices(level.nodes)[static_cast<std::size_t>(node)];
  return find_parts(level, node, built->mesh, frame.to_object * glm::inverse(world));
}

bool shows(const Level& level, std::int32_t node, const std::vector<dmat4>& world) {
  const LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  return it.in_scene && it.mesh >= 0 &&
         has_area(level.meshes[static_cast<std::size_t>(it.mesh)], dmat3(world[static_cast<std::size_t>(node)]));
}

bool surrounds(const Box& outer, const Box& inner) {
  return glm::all(glm::lessThanEqual(outer.min, inner.center())) &&
         glm::all(glm::greaterThanEqual(outer.max, inner.center())) && outer.diagonal() > inner.diagonal();
}

// The box of the node's own mesh alone. [m] world
Box own_box(const Level& level, std::int32_t node, const std::vector<dmat4>& world) {
  Box box;
  const LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  for (const Primitive& p : level.meshes[static_cast<std::size_t>(it.mesh)].primitives)
    for (const vec3& x : p.position)
      box.add(vec3(dvec3(world[static_cast<std::size_t>(node)] * glm::dvec4(dvec3(x), 1.0))));
  return box;
}

}  // namespace

Result<Organ> organ_of(const Level& level, std::int32_t node) {
  const std::vector<dmat4> world = world_matrices(level.nodes);
  Organ organ;
  if (shows(level, node, world)) {
    organ.body = node;
    // The objects that contain it, largest first.
    const Box own = own_box(level, node, world);
    std::vector<std::pair<float, std::int32_t>> around;
    for (std::int32_t i = 0; i < std::ssize(level.nodes); ++i) {
      const LevelNode& it = level.nodes[static_cast<std::size_t>(i)];
      if (i == node || it.rigid_body || !shows(level, i, world)) continue;
      if (const Box box = own_box(level, i, world); surrounds(box, own)) around.emplace_back(-box.diagonal(), i);
    }
    std::sort(around.begin(), around.end());
    for (const auto& [size, outer] : around) {
      const std::vector<std::int32_t> parts = nested_in(level, outer);
      if (std::find(parts.begin(), parts.end(), node) == parts.end()) continue;
      organ.body = outer;
      organ.parts = parts;
      return organ;
    }
  } else {
    std::vector<bool> below(level.nodes.size(), false);
    float largest = 0.0f;
    for (std::int32_t i = 0; i < std::ssize(level.nodes); ++i) {
      const std::int32_t parent = level.nodes[static_cast<std::size_t>(i)].parent;
      below[static_cast<std::size_t>(i)] = parent == node || (parent >= 0 && below[static_cast<std::size_t>(parent)]);
      if (!below[static_cast<std::size_t>(i)] || !shows(level, i, world)) continue;
      const float size = own_box(level, i, world).diagonal();
      if (size > largest) largest = size, organ.body = i;
    }
    if (organ.body < 0)
      return Error{level.nodes[static_cast<std::size_t>(node)].name, "has no mesh, and none below it",
                   "choose a node that shows one"};
  }
  organ.parts = nested_in(level, organ.body);
  return organ;
}

Result<std::string> make_soft_organ(Level& level, std::int32_t node, SoftBodyParameters parameters) {
  const Result<Organ> organ = organ_of(level, node);
  if (!organ) return organ.error();
  const LevelNode& it = level.nodes[static_cast<std::size_t>(organ->body)];
  if (it.soft_body) parameters = *it.soft_body;
  if (const Status made = make_soft(level, organ->body, as_modelled(std::move(parameters))); !made) return made.error();
  return names_of(level, organ->parts);
}

SoftBodyParameters as_modelled(SoftBodyParameters parameters) {
  parameters.under_gravity = UnderGravity::kModelled;
  parameters.carries = Carries::kInside;
  return parameters;
}

}  // namespace pliant
