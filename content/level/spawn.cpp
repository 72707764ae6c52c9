// Level -> World. Nodes become entities in order; their meshes: spawn_mesh.h, devices and effectors: spawn_device.h,
// what an object carries: spawn_carried.h.
#include <cmath>
#include <optional>

#include "components/mass_properties.h"
#include "components/soft_body.h"
#include "content/level/device_use.h"
#include "content/level/level.h"
#include "content/level/soft_contact.h"
#include "content/level/soft_store.h"
#include "content/level/spawn_carried.h"
#include "content/level/spawn_device.h"
#include "content/level/spawn_effect.h"
#include "content/level/spawn_joint.h"
#include "content/level/spawn_mesh.h"
#include "content/level/spawn_relief.h"
#include "content/level/spawn_soft.h"
#include "content/level/spawn_state.h"
#include "content/level/spawn_varying.h"
#include "content/level/tissue_cavities.h"
#include "content/level/tissue_materials.h"
#include "content/tets/surface_samples.h"

namespace pliant {
namespace {

constexpr double kFlatScale = 1e-9;  // [1] of the diagonal cubed: below it, no volume

class Spawner {
 public:
  explicit Spawner(const Level& level) : state_(level), level_(level), world_(state_.world) {}

  Status run() {
    world_.name = level_.name;
    world_.simulation = level_.simulation;
    world_.materials = level_.materials;
    world_.images = level_.images;
    if (level_.environment) {
      world_.environment.intensity = static_cast<float>(level_.environment->intensity);
      world_.environment.rotation = static_cast<float>(level_.environment->rotation);
    }
    Result<LevelMotions> motions = make_motions(level_, state_.folder, state_.scripts);
    if (!motions) return motions.error();
    state_.motions = std::move(*motions);
    state_.notes = state_.motions.notes;
    if (Status s = meshes_.count(); !s) return s;
    for (std::size_t n = 0; n < level_.nodes.size(); ++n)
      if (Status s = node(n); !s) return s;
    if (Status s = add_joints(state_); !s) return s;
    if (Status s = carry_parts(state_); !s) return s;
    meshes_.say_refinement();
    say_placeholders();
    if (Status s = devices_.link_effectors(); !s) return s;
    if (Status s = devices_.give_shells(); !s) return s;
    const std::vector<DeviceFault> shared = find_shared_devices(level_);
    if (!shared.empty()) return state_.at(shared.front().node, shared.front().what);
    return Done{};
  }
  // Only the count of run(). run() reports invalid motions; here they count as no motion.
  Status check_size() {
    Result<LevelMotions> motions = make_motions(level_, state_.folder, state_.scripts);
    state_.motions = motions ? std::move(*motions) : unmoved(level_);
    return meshes_.count();
  }
  World take() { return std::move(world_); }
  const std::vector<std::string>& notes() const { return state_.notes; }

 private:
  Status node(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    const auto parent = static_cast<std::size_t>(node.parent);
    ASSERT(node.parent < 0 || parent < n);
    if (!node.in_scene) return Done{};

    Registry& registry = world_.registry;
    const Entity entity = state_.entities[n] = registry.create();
    LevelMotions& motions = state_.motions;
    world_.hierarchy.add(entity, node.parent < 0 ? kNoEntity : state_.entities[parent]);
    registry.add<Name>(entity, {node.name});
    registry.add<LocalTransform>(entity, motions.local[n]);
    registry.add<WorldTransform>(entity, {mat4(motions.world[n])});
    if (std::optional<PrescribedMotion>& motion = motions.motion[n])
      registry.add<Kinematic>(entity, {world_.motions.add(std::move(*motion))});
    if (node.light) registry.add<Light>(entity, *node.light);
    if (node.camera) registry.add<Camera>(entity, *node.camera);
    if (const std::optional<Note> fault = soft_fault(node)) return state_.at(n, *fault);
    if (node.handle) registry.add<Handle6>(entity, *node.handle);
    if (Status s = surface(n); !s) return s;
    if (node.effect)
      if (Status s = add_effect(state_, n); !s) return s;
    if (Status s = devices_.add_device(n); !s) return s;
    if (node.probe) {
      const Pose pose = rigid_part(motions.world[n]);
      Probe& probe = registry.add<Probe>(entity, *node.probe);
      probe.position = probe.previous = pose.position;
      probe.rotation = pose.rotation;
    }
    return Done{};
  }

  // Adds Drawable, and Deformable, SoftBody or RigidBody if the node has one.
  Status surface(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    if (node.soft_body) return soft_body(n);
    if (node.mesh < 0) {
      if (node.deformable)
        return state_.at(n, "has PLIANT_deformable but no mesh", "give the node a mesh, or remove the extension");
      return Done{};
    }
    const dmat4& to_world = state_.motions.world[n];
    if (!is_touched(node) && !has_area(level_.meshes[static_cast<std::size_t>(node.mesh)], dmat3(to_world))) {
      if (placeholders_++ == 0) placeholder_ = node.name;
      return Done{};
    }
    const Entity entity = state_.entities[n];
    Result<BakedMesh> baked = meshes_.bake(n);
    if (!baked) return baked.error();
    if (has_pose(state_, n)) world_.registry.add<Pose>(entity, rigid_part(to_world));
    world_.registry.add<Drawable>(entity, {baked->draw});
    if (node.deformable) {
      Deformable& deformable = world_.registry.add<Deformable>(entity, *node.deformable);
      deformable.mesh = baked->touch;
      deformable.field = world_.fields.add({});
      if (deformable.reach <= 0.0) deformable.reach = default_reach(world_.meshes[deformable.mesh]);
      if (Status s = add_varying(state_, n); !s) return s;
      state_.built.vertices += static_cast<double>(world_.meshes[deformable.mesh].vertex_count);
      // Refined meshes have more.
      if (Status s = state_.within(n, state_.budget.ask_vertices(state_.built.vertices)); !s) return s;
    }
    if (node.rigid_body) return rigid_body(n, baked->touch);
    return Done{};
  }

  Status rigid_body(std::size_t n, Handle<Mesh> collision_mesh) {
    RigidBody& body = world_.registry.add<RigidBody>(state_.entities[n], *level_.nodes[n].rigid_body);
    body.collision_mesh = collision_mesh;
    const Mesh& mesh = world_.meshes[collision_mesh];
    const double box = std::pow(static_cast<double>(mesh.box.diagonal()), 3.0);
    if (body.fixed || mass_properties(mesh).volume > kFlatScale * box) return Done{};
    return state_.at(n, "has PLIANT_rigid_body but its mesh encloses no volume", "close the mesh, or set `fixed`");
  }

  // Soft bodies share nothing, because pinned nodes are per body.
  Status soft_body(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    const LevelMesh* mesh = node.mesh < 0 ? nullptr : &level_.meshes[static_cast<std::size_t>(node.mesh)];
    if (mesh)
      if (Status s = state_.count_triangles(n, state_.budget.of(node.mesh).triangles); !s) return s;
    const dmat4& to_world = state_.motions.world[n];
    const Pose pose = rigid_part(to_world);
    state_.say_preparing(n, node.name);
    LevelNode asked = node;
    if (asked.soft_body->contact == SoftContact::kAuto && !why_plain(level_, node).empty())
      asked.soft_body->contact = SoftContact::kLattice;
    Result<SoftParts> parts = find_soft_parts(asked, mesh, mat4(world_to(pose) * to_world), state_.folder);
    if (!parts) return state_.around(n, parts.error());
    if (Status s = set_materials(level_, node, world_to(pose), state_.motions.world, *parts); !s)
      return state_.around(n, s.error());
    if (Status s = set_cavities(level_, node, world_to(pose), state_.motions.world, *parts); !s)
      return state_.around(n, s.error());
    tetrahedra_ += static_cast<double>(parts->tets.tets.size());
    if (Status s = state_.within(n, LevelBudget::ask(limits::kTets, tetrahedra_)); !s) return s;
    for (const std::string& note : parts->notes) state_.notes.push_back(node.soft_body->mesh + ": " + note);
    for (const Note& note : parts->tets.report.notes) state_.notes.push_back("`" + node.name + "`: " + note.message());
    meshes_.note_winding(node.mesh, parts->surface);
    const Entity entity = state_.entities[n];
    world_.registry.add<Pose>(entity, pose);
    SoftBody& body = world_.registry.add<SoftBody>(entity, *node.soft_body);
    body.contact = parts->split ? SoftContact::kSplit : SoftContact::kLattice;
    if (parts->split) parts->tets.samples = sample_surface(parts->surface.mesh, parts->tets);
    body.tets = world_.tet_meshes.add(std::move(parts->tets));
    body.collision_mesh = world_.meshes.add(std::move(parts->surface.mesh));
    if (node.deformable) {
      Deformable& law = world_.registry.add<DentLaw>(entity, {*node.deformable});
      law.mesh = body.collision_mesh;
      if (law.reach <= 0.0) law.reach = default_reach(world_.meshes[law.mesh]);
    }
    world_.registry.add<Drawable>(entity, {world_.draw_meshes.add(std::move(parts->surface.draw))});
    return Done{};
  }

  void say_placeholders() {
    if (placeholders_ == 0) return;
    const std::string more = placeholders_ == 1 ? "" : " and " + with_commas(placeholders_ - 1) + " more";
    state_.notes.push_back("`" + placeholder_ + "`" + more + ": no triangle with an area; left out as a placeholder");
  }

  SpawnState state_;
  const Level& level_;
  World& world_;  // of the state
  MeshBaker meshes_{state_};
  DeviceSpawner devices_{state_};
  double tetrahedra_ = 0.0;       // so far
  std::size_t placeholders_ = 0;  // nodes whose mesh has no surface
  std::string placeholder_;       // the first of them
};

}  // namespace

Status check_level_size(const Level& level) {
  return Spawner(level).check_size();
}

Result<World> spawn_level(const Level& level, std::vector<std::string>* notes) {
  Spawner spawner(level);
  if (Status s = spawner.run(); !s) return s.error();
  if (notes) notes->insert(notes->end(), spawner.notes().begin(), spawner.notes().end());
  World world = spawner.take();
  if (!world.images.empty()) add_relief(world, notes);  // else they come later, or never
  return world;
}

}  // namespace pliant
