// The sides that a joint can have: rigid bodies, rigid parts of soft bodies, and points of tissue.
#include <fmt/format.h>

#include "components/soft_body.h"
#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/joint/joints.h"

namespace pliant {

// Its rigid part of this name.
Result<std::int32_t> Joints::part_of(const World& world, const Body& body, const std::string& where,
                                     const std::string& name) {
  if (name.empty()) return -1;
  const SoftBody* const soft = world.registry.find<SoftBody>(body.entity);
  const SoftBodyState* const state = body.as_tissue();
  std::string has;
  const std::size_t count = soft && state ? state->tets().rigid_counts.size() : 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (soft->rigid[i].name == name) return static_cast<std::int32_t>(i);
    has += "`" + soft->rigid[i].name + "`, ";
  }
  const bool held = state && state->has_handle();
  if (held && name == kHandlePart) return static_cast<std::int32_t>(count);
  if (held) has += fmt::format("`{}`, ", kHandlePart);
  return Error{where, "joins the rigid part `" + name.substr(0, 100) + "` of a body that has none of that name",
               has.empty() ? "leave it out, or name the part in `rigid` of its PLIANT_soft_body"
                           : "name one of " + has.substr(0, has.size() - 2)};
}

Pose Joints::pose_of(const Body& body, const Side& side, double T) {
  return side.part >= 0 ? *body.part_pose(side.part, T) : *body.pose_after(T);
}

Pose Joints::frame_of(const std::vector<std::unique_ptr<Body>>& bodies, const Side& side, double T) {
  const Pose pose = pose_of(*bodies[side.body], side, T);
  return {pose.to_world(side.frame.position), pose.rotation * side.frame.rotation};
}

SurfacePoint Joints::point_of(const std::vector<std::unique_ptr<Body>>& bodies, const Side& side, std::size_t i,
                              double T) {
  const Body& body = *bodies[side.body];
  SurfacePoint out = side.on[i];
  if (side.rigid) {
    out.position = pose_of(body, side, T).to_world(side.point[i]);
    out.part = side.part;
    return out;
  }
  const uvec3 corner = body.collision_mesh->triangles[out.triangle];
  out.position = dvec3(0.0);
  for (int k = 0; k < 3; ++k) out.position += out.barycentric[k] * body.surface_position[corner[k]];
  if (T > 0.0) out.position += T * body.velocity_of(out);
  return out;
}

}  // namespace pliant
