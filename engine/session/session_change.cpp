#include "engine/session/session_change.h"

#include <fmt/format.h>

#include "components/probe_shape.h"
#include "content/level/spawn_soft.h"
#include "engine/session/scene_check.h"
#include "systems/soft/body/probe_tool.h"
#include "systems/soft/body/tissue_material.h"
#include "systems/soft/prepare_soft.h"
#include "systems/touch/model/force_field.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

bool is_painted(const Mesh& mesh) {
  return !mesh.stiffness_factor.empty() || !mesh.damping_factor.empty() || !mesh.relaxation_factor.empty();
}

// True if paint_motion must be repeated.
bool moves_otherwise(const Motion& a, const Motion& b) {
  return a.mass != b.mass || a.damping != b.damping || a.arm_stiffness != b.arm_stiffness || a.arm_time != b.arm_time ||
         a.law.kind != b.law.kind || a.law.cubic != b.law.cubic || a.law.stiffening != b.law.stiffening;
}

Result<SurfaceSetting> surface_setting(const World& world, const std::string& where, const Deformable& before,
                                       Deformable& now) {
  const Mesh& mesh = world.meshes[before.mesh];
  const bool arm = has_arm(before.spring);
  if (arm != has_arm(now.spring))
    return Error{where, "a law that relaxes keeps a memory that is laid out when the session opens",
                 "change it in the scene and open that again"};
  if (now.reach == 0.0) now.reach = default_reach(mesh);
  const Motion motion_now = motion(now, world.touch->dt);
  if (is_painted(mesh) && moves_otherwise(motion(before, world.touch->dt), motion_now))
    return Error{where, "is painted on this surface, and is read when the session opens", "change the scene instead"};
  const double reach = std::max(now.reach, kLeastReach * static_cast<double>(mesh.mean_edge));
  return SurfaceSetting{now, motion_now,
                        share_kernel(now.shape, reach, now.volume, contact_radius(now, reach) / reach)};
}

CouplingSetting coupling_of(const HandleParameters& handle) {
  return {handle.translation, handle.rotation, handle.max_force, handle.max_torque};
}

Result<SessionChange> change_surface(const World& world, const LiveNamed& named, const std::string& where,
                                     Deformable& now) {
  auto setting = surface_setting(world, where, *named.node.deformable, now);
  if (!setting) return setting.error();
  if (Status s = check(now, "`" + named.name + "`"); !s) return s.error();
  SessionChange change;
  change.entity = named.object;
  change.touch.push_back({change.entity, *setting, 0});
  change.soft.push_back({change.entity, setting->now});
  return change;
}

Result<SessionChange> change_rigid(const World& world, const LiveNamed& named, const LevelNode& node) {
  SessionChange change;
  change.entity = named.object;
  RigidBody body = *node.rigid_body;
  body.collision_mesh = named.node.rigid_body->collision_mesh;
  RigidSetting now{{}, body.friction_static, body.friction_sliding};
  if (!body.fixed) {
    const Result<RigidMass> mass = rigid_mass(world, change.entity, body);
    if (!mass) return mass.error();
    now.mass = *mass;
    if (node.handle && !node.handle->carried)
      change.touch.push_back({change.entity, WeightSetting{now.mass.mass * world.simulation.gravity}, 0});
  }
  change.soft.push_back({change.entity, now});
  return change;
}

SessionChange change_soft(const LiveNamed& named, const SoftBody& body) {
  SessionChange change;
  change.entity = named.object;
  change.soft.push_back({change.entity, SoftSetting{material_of(body), body.friction_static, body.friction_sliding}});
  return change;
}

Result<SessionChange> change_probe(const World& world, const LiveNamed& named, const std::string& where,
                                   const Probe& now) {
  const Probe& before = *named.node.probe;
  SessionChange change;
  change.entity = named.hand;
  if (now.coupling != before.coupling || now.radius == before.radius) {
    const HandleParameters handle = probe_handle(now, *named.node.device);
    change.touch.push_back({change.entity, coupling_of(handle), 0});
    change.soft.push_back({change.entity, coupling_of(handle)});
    return change;
  }
  constexpr const char* kAgain = "; change it in the scene and open that again";
  if (has_capsule(now))
    return Error{where, std::string("a capsule's tips are laid out by it when the session opens") + kAgain};
  if ((now.radius > 0.0) != (before.radius > 0.0))
    return Error{where, std::string("a point and a sphere have different places for contacts") + kAgain};
  if (world.soft && now.meets != ProbeMeets::kSurfaces)
    return Error{where, std::string("its shape among soft and rigid bodies is made with it") + kAgain +
                            ", or let it meet surfaces alone"};
  change.touch.push_back({change.entity, ProbeSetting{now.radius}, 0});
  return change;
}

SessionChange change_handle(const LiveNamed& named, const Handle6& handle) {
  SessionChange change;
  change.entity = named.hand;
  change.touch.push_back({change.entity, coupling_of(handle), 0});
  change.soft.push_back({change.entity, coupling_of(handle)});
  return change;
}

Result<SessionChange> change_effect(const LiveNamed& named, const std::string& where, const std::string& key,
                                    const Effect& now) {
  SessionChange change;
  change.entity = named.effect;
  if (named.several_effects) return Error{where, "several effects have this name", "give each its own"};
  if (!reads_key(now.kind, key))
    return Error{where, fmt::format("is not read by an effect of the kind {}", row_of(now.kind).word),
                 fmt::format("it reads: {}", row_of(now.kind).reads)};
  change.touch.push_back({change.entity, EffectSetting(now), 0});
  return change;
}

}  // namespace

Result<SessionChange> change_of(const World& world, const LiveNamed& named, const std::string& where,
                                const Extension& extension, const Key& key, LevelNode& now) {
  if (extension.name == "deformable") return change_surface(world, named, where, *now.deformable);
  if (extension.name == "rigid_body") return change_rigid(world, named, now);
  if (extension.name == "soft_body") {
    if (const std::optional<Note> fault = law_fault(now)) return Error{where, fault->what, fault->cure};
    return change_soft(named, *now.soft_body);
  }
  if (extension.name == "probe") return change_probe(world, named, where, *now.probe);
  if (extension.name == "effect") return change_effect(named, where, key.name, *now.effect);
  if (extension.name == "handle") return change_handle(named, *now.handle);
  if (Status s = check_device(named.name, *now.device); !s) return s.error();
  SessionChange change;
  change.entity = named.device;
  change.touch.push_back({change.entity, static_cast<const DeviceParameters&>(*now.device), 0});
  return change;
}

}  // namespace pliant
