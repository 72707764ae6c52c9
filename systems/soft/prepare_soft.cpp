#include "systems/soft/prepare_soft.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/mass_properties.h"
#include "components/soft_body.h"
#include "runtime/long_work.h"
#include "systems/soft/body/probe_tool.h"
#include "systems/soft/body/rigid_state.h"
#include "systems/soft/body/rigid_tool.h"
#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/soft_state.h"
#include "systems/soft/under_gravity.h"
#include "systems/touch/collide/surface_query.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

std::string soft_name(const World& world, Entity entity) {
  const Name* name = world.registry.find<Name>(entity);
  return "body `" + (name ? name->value : fmt::format("entity {}", entity.index)) + "`";
}

Pose pose_of(const World& world, Entity entity) {
  const Pose* pose = world.registry.find<Pose>(entity);
  return pose ? *pose : Pose{};
}

void add(SoftState& soft, Entity entity, std::unique_ptr<Body> body) {
  body->entity = entity;
  if (body->size() > 0) soft.moving.push_back(static_cast<std::uint32_t>(soft.bodies.size()));
  soft.bodies.push_back(std::move(body));
}

Status check_step(const World& world, Entity entity, const SoftBody& body) {
  if (body.integrator == StepMethod::kEuler) return Done{};
  const char* const cure = "leave out `integrator`";
  if (world.registry.find<Handle6>(entity))
    return Error{soft_name(world, entity), "has an `integrator`, and a tool's tissue steps by `euler` only", cure};
  const TetMesh& tets = world.tet_meshes[body.tets];
  if (body.integrator == StepMethod::kQuasiStatic && tets.pinned_begin() == tets.node_count())
    return Error{soft_name(world, entity), "has an `integrator` of `quasi_static`, and nothing holds it",
                 "pin a part of it (`pinned`), or take `euler`"};
  return Done{};
}

Status add_soft(const World& world, SoftState& soft) {
  for (auto [entity, body] : world.registry.view<SoftBody>()) {
    check_in("preparing " + soft_name(world, entity));
    if (!make_solver(body.solver, 1))
      return Error{soft_name(world, entity), "its solver is not in this build, or its factory makes none",
                   "use `auto`"};
    if (Status status = check_step(world, entity, body); !status) return status;
    const Handle6* handle = world.registry.find<Handle6>(entity);
    auto state = std::make_unique<SoftBodyState>(world.tet_meshes[body.tets], world.meshes[body.collision_mesh], body,
                                                 handle, pose_of(world, entity), body.solver);
    state->friction_static = body.friction_static;
    state->friction_sliding = body.friction_sliding;
    if (const DentLaw* law = world.registry.find<DentLaw>(entity))
      state->set_dent_law(*law, world.simulation.soft_step);
    std::vector<const std::vector<uvec3>*> parts;
    for (const CarriedPart& part : world.tet_meshes[body.tets].parts)
      parts.push_back(&world.meshes[part.mesh].triangles);
    state->set_part_meshes(std::move(parts));
    state->self_collides = true;  // fingers pinch, a strip folds
    if (!handle) state->start_with(body.velocity);
    add(soft, entity, std::move(state));
  }
  return Done{};
}

Status add_rigid(const World& world, SoftState& soft) {
  for (auto [entity, body] : world.registry.view<RigidBody>()) {
    const Mesh& mesh = world.meshes[body.collision_mesh];
    const Pose pose = pose_of(world, entity);
    std::unique_ptr<Body> state;
    if (body.fixed) {
      state = std::make_unique<FixedBody>(mesh, pose);
      if (std::vector<KinematicBody::Link> links = links_of(world, entity); !links.empty())
        soft.kinematic.push_back({static_cast<std::uint32_t>(soft.bodies.size()), std::move(links)});
    } else {
      const Result<RigidMass> mass = rigid_mass(world, entity, body);
      if (!mass) return mass.error();
      if (const Handle6* handle = world.registry.find<Handle6>(entity))
        state = std::make_unique<RigidTool>(mesh, *mass, *handle, pose);
      else
        state = std::make_unique<RigidState>(mesh, pose, *mass), state->start_with(body.velocity);
    }
    state->friction_static = body.friction_static;
    state->friction_sliding = body.friction_sliding;
    add(soft, entity, std::move(state));
  }
  return Done{};
}

void add_probes(const World& world, SoftState& soft) {
  for (const Entity entity : probe_tools(world)) {
    const Probe& probe = world.registry.get<Probe>(entity);
    const HapticDevice& device = world.registry.get<HapticDevice>(probe.device);
    auto tool = std::make_unique<RigidTool>(world.meshes[probe.shell], probe_mass(), probe_handle(probe, device),
                                            Pose{probe.position, probe.rotation});
    tool->kind = BodyKind::kProbe;
    tool->tips = tips_of(probe, world.meshes[probe.shell]);
    tool->absent = true;  // until its device is sensed
    add(soft, entity, std::move(tool));
  }
}

void add_yielding(const World& world, SoftState& soft) {
  for (std::size_t slot = 0; slot < world.touch->objects.size(); ++slot) {
    const Entity entity = world.touch->objects[slot].entity;
    const Deformable& deformable = world.registry.get<Deformable>(entity);
    soft.yielding.push_back(static_cast<std::uint32_t>(soft.bodies.size()));
    add(soft, entity,
        std::make_unique<YieldingBody>(world.meshes[deformable.mesh], deformable, pose_of(world, entity), slot));
    soft.bodies.back()->kind = BodyKind::kSurface;
  }
}

// All arrays have their final size.
SoftSnapshot first_snapshot(const SoftState& soft) {
  SoftSnapshot snapshot;
  snapshot.contacts.reserve(kMaxShownContacts);
  for (const std::uint32_t i : soft.moving) {
    if (soft.bodies[i]->kind == BodyKind::kProbe) continue;  // shown by a marker
    snapshot.objects.emplace_back();
    soft.bodies[i]->show(snapshot.objects.back());
    if (const auto* tissue = soft.bodies[i]->as_tissue())
      for (std::size_t part = 0; part < tissue->part_count(); ++part) {
        snapshot.objects.emplace_back();
        tissue->show_part(part, snapshot.objects.back());
      }
    const auto* body = soft.bodies[i]->as_tool();
    if (body && body->has_handle()) snapshot.handles.push_back({body->entity, body->handle().object_pose(), {}, {}});
  }
  return snapshot;
}

// Whether one of these points has passed through the body's collision mesh, which is entirely at rest.
bool come_through(const World& world, const Body& body, const std::vector<dvec3>& from, const std::vector<dvec3>& to) {
  const Pose pose = pose_of(world, body.entity);
  for (std::size_t i = 0; i < from.size(); ++i)
    if (first_entry(*body.collision_mesh, pose.to_local(from[i]), pose.to_local(to[i])).valid()) return true;
  return false;
}

// Tissue of tools begins in equilibrium. It settles without contacts; if it passed through something, it begins in its
// rest shape and falls onto it instead.
void settle_tools(const World& world, SoftState& soft) {
  for (const std::unique_ptr<Body>& body : soft.bodies) {
    auto* tool = body->as_tool();
    if (tool) check_in("settling " + soft_name(world, tool->entity));
    if (!tool || !tool->has_handle()) continue;
    const std::vector<dvec3> rest = tool->surface_position;
    tool->settle(world.simulation.gravity);
    const auto is_in_the_way = [&](const std::unique_ptr<Body>& other) {
      return other != body && come_through(world, *other, rest, tool->surface_position);
    };
    if (std::any_of(soft.bodies.begin(), soft.bodies.end(), is_in_the_way)) tool->unsettle();
  }
}

}  // namespace

Result<RigidMass> rigid_mass(const World& world, Entity entity, const RigidBody& body) {
  const MassProperties shape = mass_properties(world.meshes[body.collision_mesh]);
  const double mass = body.mass > 0.0 ? body.mass : body.density * shape.volume;
  const double density = mass / shape.volume;
  const dmat3 inertia = density * shape.inertia;
  if (!(mass > 0.0 && std::isfinite(density) && glm::determinant(inertia) > 0.0))
    return Error{soft_name(world, entity), "encloses no volume, so it has no weight to move with",
                 "close its surface, or make it `fixed`"};
  return RigidMass{mass, shape.centre, inertia};
}

Status prepare_soft(World& world) {
  world.soft = nullptr;
  world.soft_snapshots = nullptr;
  auto soft = std::make_shared<SoftState>();
  begin_under_gravity(world);
  if (Status status = add_soft(world, *soft); !status) return status;
  if (Status status = add_rigid(world, *soft); !status) return status;
  add_probes(world, *soft);
  if (soft->moving.empty()) return Done{};
  const double T = world.simulation.soft_step;
  if (!(T > 0.0 && T <= 1.0))
    return Error{"PLIANT_simulation/soft_step", fmt::format("is {} s", T), "give more than 0 and at most 1 s"};
  if (world.touch->presses) add_yielding(world, *soft);  // with probes alone, P1 handles these surfaces
  settle_tools(world, *soft);
  if (Status status = soft->joints.prepare(world, soft->bodies); !status) return status;
  soft->proximity = std::make_unique<Proximity>(soft->bodies);
  soft->split.prepare(soft->bodies);
  world.soft_snapshots = std::make_unique<TripleBuffer<SoftSnapshot>>(first_snapshot(*soft));
  world.soft = std::move(soft);
  return Done{};
}

}  // namespace pliant
