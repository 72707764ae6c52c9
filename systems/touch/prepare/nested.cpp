#include "systems/touch/prepare/nested.h"

#include <fmt/format.h>

#include "systems/touch/collide/surface_query.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

constexpr std::uint32_t kTried = 16;  // vertices, spread over the inner surface

bool is_inside(const World& world, const ObjectState& outer, const ObjectState& inner) {
  const Mesh &around = world.meshes[world.registry.get<Deformable>(outer.entity).mesh],
             &mesh = world.meshes[world.registry.get<Deformable>(inner.entity).mesh];
  if (!around.closed || outer.world_box.empty() || inner.world_box.empty()) return false;
  const Pose &to = world.registry.get<Pose>(outer.entity), &from = world.registry.get<Pose>(inner.entity);
  const auto size = static_cast<double>(around.box.diagonal());
  for (std::uint32_t i = 0; i < kTried; ++i) {
    const std::uint32_t v = static_cast<std::uint32_t>(std::uint64_t{i} * mesh.vertex_count / kTried);
    const SurfaceFoot foot = nearest(around, to.to_local(from.to_world(dvec3(mesh.position(v)))), 2 * size);
    if (!foot.valid() || !(foot.height < -1e-6 * size)) return false;
  }
  return true;
}

std::string surface_name(const World& world, Entity entity) {
  const Name* name = world.registry.find<Name>(entity);
  return name ? name->value : std::string();
}

}  // namespace

std::vector<Note> explain_nested(const World& world) {
  std::vector<Note> notes;
  for (const ObjectState& outer : world.touch->objects)
    world.touch->object_boxes.visit(outer.world_box, [&](std::uint32_t slot) {
      const ObjectState& inner = world.touch->objects[slot];
      if (&inner == &outer || !is_inside(world, outer, inner)) return;
      const std::string a = surface_name(world, outer.entity), b = surface_name(world, inner.entity);
      notes.push_back(
          {fmt::format("`{}` is inside of `{}`: a probe that presses down to it feels the sum of both forces", b, a),
           fmt::format("make `{}` no PLIANT_deformable, drawn with `carries` of `{}`, or move it out", b, a),
           "surface.nested", b});
    });
  return notes;
}

}  // namespace pliant
