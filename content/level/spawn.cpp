// Level -> World. Nodes become entities in order. A mesh is built once for every distinct scale of its nodes.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include "components/mass_properties.h"
#include "components/soft_body.h"
#include "content/files/file_io.h"
#include "content/level/carried_parts.h"
#include "content/level/device_use.h"
#include "content/level/level.h"
#include "content/level/level_budget.h"
#include "content/level/probe_shell.h"
#include "content/level/script.h"
#include "content/level/soft_store.h"
#include "content/level/spawn_motion.h"
#include "content/level/spawn_soft.h"
#include "content/mesh/mesh_build.h"
#include "content/mesh/mesh_finer.h"
#include "runtime/long_work.h"

namespace pliant {
namespace {

constexpr double kDentDepth = 1.5;   // [1] of a surface's reach: depth up to which a dent moves carried parts below it
constexpr double kFlatScale = 1e-9;  // [1] of the diagonal cubed: below it, no volume

dmat4 inverse(const Pose& pose) {
  const dquat back = glm::conjugate(pose.rotation);
  dmat4 m = glm::mat4_cast(back);
  m[3] = glm::dvec4(back * -pose.position, 1.0);
  return m;
}

std::string with_commas(std::size_t number) {
  std::string text = std::to_string(number);
  for (std::size_t i = text.size(); i > 3;) text.insert(i -= 3, ",");
  return text;
}

// Properties that nodes must have in common to share a built mesh.
struct TouchShape {
  bool touchable;
  double crease_angle;              // [rad]
  std::array<float, 16> to_object;  // the transform baked into the mesh
  auto operator<=>(const TouchShape&) const = default;
};

mat4 matrix_of(const TouchShape& shape) {
  mat4 m;
  for (std::size_t i = 0; i < 16; ++i) m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = shape.to_object[i];
  return m;
}

// A mesh as built for a node.
struct Baked {
  std::optional<DentSize> dents;  // dents that the mesh must resolve; empty: none
  bool refined = false;           // refined for that
  Handle<Mesh> touch;
  Handle<DrawMesh> draw;
};

class Spawner {
 public:
  explicit Spawner(const Level& level) : level_(level), folder_(level.path.parent_path()), budget_(level) {}

  Status run() {
    world_.name = level_.name;
    world_.simulation = level_.simulation;
    world_.materials = level_.materials;
    world_.images = level_.images;
    if (level_.environment) {
      world_.environment.intensity = static_cast<float>(level_.environment->intensity);
      world_.environment.rotation = static_cast<float>(level_.environment->rotation);
    }
    entities_.assign(level_.nodes.size(), kNoEntity);
    Result<LevelMotions> motions = make_motions(level_, folder_, scripts_);
    if (!motions) return motions.error();
    motions_ = std::move(*motions);
    notes_.insert(notes_.end(), motions_.notes.begin(), motions_.notes.end());
    baked_.resize(level_.meshes.size());
    if (Status s = count(); !s) return s;
    for (std::size_t n = 0; n < level_.nodes.size(); ++n)
      if (Status s = node(n); !s) return s;
    for (std::size_t n = 0; n < level_.nodes.size(); ++n)
      if (Status s = carry_parts(n); !s) return s;
    say_refinement();
    say_placeholders();
    for (std::size_t n = 0; n < level_.nodes.size(); ++n)
      if (Status s = link_probe(n); !s) return s;
    for (std::size_t n = 0; n < level_.nodes.size(); ++n)
      if (Status s = check_handle(n); !s) return s;
    if (Status s = give_shells(); !s) return s;
    const std::vector<DeviceFault> shared = find_shared_devices(level_);
    if (!shared.empty()) return at(shared.front().node, error_at("", shared.front().what));
    return Done{};
  }
  // Only the count of run(). run() reports invalid motions; here they count as no motion.
  Status check_size() {
    Result<LevelMotions> motions = make_motions(level_, folder_, scripts_);
    motions_ = motions ? std::move(*motions) : unmoved(level_);
    return count();
  }
  World take() { return std::move(world_); }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  Error at(std::size_t n, Error error) const {
    error.where = level_.path.filename().string() + ": node `" + level_.nodes[n].name + "`";
    error.node = static_cast<std::int32_t>(n);
    return error;
  }
  Error at(std::size_t n, std::string what, std::string cure) const {
    return at(n, Error{"", std::move(what), std::move(cure)});
  }
  // With the place of the inner error in the text.
  Error around(std::size_t n, Error error) const {
    if (!error.where.empty()) error.what = error.where + ": " + error.what;
    return at(n, std::move(error));
  }

  double share_of(std::size_t n) const { return static_cast<double>(n) / static_cast<double>(level_.nodes.size()); }

  Status node(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    const auto parent = static_cast<std::size_t>(node.parent);
    ASSERT(node.parent < 0 || parent < n);
    if (!node.in_scene) return Done{};

    Registry& registry = world_.registry;
    const Entity entity = entities_[n] = registry.create();
    world_.hierarchy.add(entity, node.parent < 0 ? kNoEntity : entities_[parent]);
    registry.add<Name>(entity, {node.name});
    registry.add<LocalTransform>(entity, motions_.local[n]);
    registry.add<WorldTransform>(entity, {mat4(motions_.world[n])});
    if (std::optional<PrescribedMotion>& motion = motions_.motion[n])
      registry.add<Kinematic>(entity, {world_.motions.add(std::move(*motion))});
    if (!by_name_.count(node.name)) by_name_[node.name] = n;
    if (node.light) registry.add<Light>(entity, *node.light);
    if (node.camera) registry.add<Camera>(entity, *node.camera);
    if (const std::optional<Note> fault = soft_fault(node)) return at(n, error_at("", *fault));
    if (node.handle) registry.add<Handle6>(entity, *node.handle);
    if (Status s = surface(n); !s) return s;
    if (Status s = device(n); !s) return s;
    if (node.probe) {
      const Pose pose = rigid_part(motions_.world[n]);
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
        return at(n, "has PLIANT_deformable but no mesh", "give the node a mesh, or remove the extension");
      return Done{};
    }
    if (!is_touched(node) && !has_area(level_.meshes[static_cast<std::size_t>(node.mesh)], dmat3(motions_.world[n]))) {
      if (placeholders_++ == 0) placeholder_ = node.name;
      return Done{};
    }
    const Pose pose = rigid_part(motions_.world[n]);
    Result<Baked> baked = bake(n);
    if (!baked) return baked.error();
    if (has_pose(n)) world_.registry.add<Pose>(entities_[n], pose);
    world_.registry.add<Drawable>(entities_[n], {baked->draw});
    if (node.deformable) {
      Deformable& deformable = world_.registry.add<Deformable>(entities_[n], *node.deformable);
      deformable.mesh = baked->touch;
      deformable.field = world_.fields.add({});
      if (deformable.reach <= 0.0) deformable.reach = default_reach(world_.meshes[deformable.mesh]);
      built_.vertices += static_cast<double>(world_.meshes[deformable.mesh].vertex_count);
      if (Status s = within(n, budget_.ask_vertices(built_.vertices)); !s) return s;  // refined meshes have more
    }
    if (node.rigid_body) return rigid_body(n, baked->touch);
    return Done{};
  }

  Status rigid_body(std::size_t n, Handle<Mesh> collision_mesh) {
    RigidBody& body = world_.registry.add<RigidBody>(entities_[n], *level_.nodes[n].rigid_body);
    body.collision_mesh = collision_mesh;
    const Mesh& mesh = world_.meshes[collision_mesh];
    const double box = std::pow(static_cast<double>(mesh.box.diagonal()), 3.0);
    if (body.fixed || mass_properties(mesh).volume > kFlatScale * box) return Done{};
    return at(n, "has PLIANT_rigid_body but its mesh encloses no volume", "close the mesh, or set `fixed`");
  }

  // A moving node that is only drawn may change its scale, so its transform is not baked into its mesh.
  bool has_pose(std::size_t n) const { return is_touched(level_.nodes[n]) || !motions_.moves[n]; }
  TouchShape shape_of(std::size_t n) const {
    const LevelNode& node = level_.nodes[n];
    const mat4 m = has_pose(n) ? mat4(inverse(rigid_part(motions_.world[n])) * motions_.world[n]) : mat4(1);
    TouchShape shape{is_touched(node), node.deformable ? node.deformable->crease_angle : 0.0, {}};
    for (std::size_t i = 0; i < 16; ++i) shape.to_object[i] = m[static_cast<int>(i / 4)][static_cast<int>(i % 4)];
    return shape;
  }

  static bool is_touched(const LevelNode& node) { return node.deformable || node.rigid_body; }

  // Soft bodies share nothing, because pinned nodes are per body.
  Status soft_body(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    const LevelMesh* mesh = node.mesh < 0 ? nullptr : &level_.meshes[static_cast<std::size_t>(node.mesh)];
    if (mesh)
      if (Status s = count_triangles(n, budget_.of(node.mesh).triangles); !s) return s;
    const Pose pose = rigid_part(motions_.world[n]);
    progress_.say("preparing meshes, now `" + node.name + "`", share_of(n));
    Result<SoftParts> parts = find_soft_parts(node, mesh, mat4(inverse(pose) * motions_.world[n]), folder_);
    if (!parts) return around(n, parts.error());
    tetrahedra_ += static_cast<double>(parts->tets.tets.size());
    if (Status s = within(n, LevelBudget::ask(limits::kTets, tetrahedra_)); !s) return s;
    for (const std::string& note : parts->notes) notes_.push_back(node.soft_body->mesh + ": " + note);
    for (const Note& note : parts->tets.report.notes) notes_.push_back("`" + node.name + "`: " + note.message());
    note_winding(node.mesh, parts->surface);
    world_.registry.add<Pose>(entities_[n], pose);
    SoftBody& body = world_.registry.add<SoftBody>(entities_[n], *node.soft_body);
    body.tets = world_.tet_meshes.add(std::move(parts->tets));
    body.collision_mesh = world_.meshes.add(std::move(parts->surface.mesh));
    world_.registry.add<Drawable>(entities_[n], {world_.draw_meshes.add(std::move(parts->surface.draw))});
    return Done{};
  }

  // Attaches drawn parts inside a deformable object to it, or notes that they stay fixed.
  Status carry_parts(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    if (!node.in_scene) return Done{};
    const SoftBody* const soft = world_.registry.find<SoftBody>(entities_[n]);
    const Deformable* const surface = world_.registry.find<Deformable>(entities_[n]);
    const bool carries = soft ? soft->carries == Carries::kInside : surface && surface->carries == Carries::kInside;
    if (!soft && !carries) return Done{};  // a dent is local: parts that stay need no note
    const Mesh& mesh = world_.meshes[soft ? soft->collision_mesh : surface->mesh];
    const dmat4 to_object = inverse(rigid_part(motions_.world[n]));
    std::vector<std::int32_t> parts =
        find_parts(level_, static_cast<std::int32_t>(n), mesh, to_object, soft ? soft->fill : Fill::kSolid);
    std::erase_if(parts, [&](std::int32_t part) {
      const auto p = static_cast<std::size_t>(part);
      return motions_.moves[p] || !world_.registry.has<Drawable>(entities_[p]) ||
             world_.registry.has<Carried>(entities_[p]);
    });
    if (parts.empty()) return Done{};
    if (!carries) {
      Note note{fmt::format("leaves behind what lies inside of it and is only drawn ({})", names_of(level_, parts)),
                "set `carries` to `inside`, and it goes along", "tissue.leaves_behind", node.name};
      notes_.push_back("`" + node.name + "`: " + note.message());
      world_.tet_meshes[soft->tets].report.notes.push_back(std::move(note));
      return Done{};
    }
    for (const std::int32_t part : parts)
      if (Status s = carry(n, static_cast<std::size_t>(part), to_object); !s) return s;
    return Done{};
  }

  // Rebuilds the part's mesh in the frame of its carrier.
  Status carry(std::size_t by, std::size_t part, const dmat4& to_object) {
    const LevelNode& node = level_.nodes[part];
    const LevelMesh& mesh = level_.meshes[static_cast<std::size_t>(node.mesh)];
    if (Status s = count_triangles(part, budget_.of(node.mesh).triangles); !s) return s;
    Result<BuiltMesh> built =
        build_mesh(node.name, mesh.primitives, mat4(to_object * motions_.world[part]), {0.0, {}, false});
    if (!built) return around(part, built.error());
    const Entity entity = entities_[part];
    Carried carried{entities_[by], {}, {}};
    if (const SoftBody* const soft = world_.registry.find<SoftBody>(entities_[by])) {
      TetMesh& tets = world_.tet_meshes[soft->tets];
      CarriedPart& to = tets.parts.emplace_back();
      to.entity = entity;
      embed_part(built->mesh, tets, to);
      carried.mesh = to.mesh = world_.meshes.add(std::move(built->mesh));
    } else {
      const Deformable& surface = world_.registry.get<Deformable>(entities_[by]);
      carried.mesh = surface.mesh;
      carried.share = dent_shares(built->draw, world_.meshes[surface.mesh], kDentDepth * surface.reach);
    }
    world_.registry.add<Carried>(entity, std::move(carried));
    world_.registry.get<Drawable>(entity).mesh = world_.draw_meshes.add(std::move(built->draw));
    const Pose pose = rigid_part(motions_.world[by]);
    if (Pose* const its = world_.registry.find<Pose>(entity))
      *its = pose;
    else
      world_.registry.add<Pose>(entity, pose);
    return Done{};
  }

  // Counts the total size before anything is built.
  Status count() {
    std::set<std::pair<std::int32_t, TouchShape>> shapes;
    MeshSize wanted;
    double surfaces = 0.0, soft_bodies = 0.0, hands = 0.0;
    for (std::size_t n = 0; n < level_.nodes.size(); ++n) {
      const LevelNode& node = level_.nodes[n];
      if (!node.in_scene) continue;
      hands += node.probe || node.handle;
      soft_bodies += node.soft_body.has_value();
      surfaces += is_touched(node);
      if (node.mesh >= 0) {
        const MeshSize& size = budget_.of(node.mesh);
        if (node.soft_body || shapes.insert({node.mesh, shape_of(n)}).second) wanted.triangles += size.triangles;
        if (node.deformable) wanted.vertices += size.vertices;
      }
      for (const std::optional<Note>& over :
           {LevelBudget::ask(limits::kHands, hands), LevelBudget::ask(limits::kSoftBodies, soft_bodies),
            LevelBudget::ask(limits::kSurfaces, surfaces), budget_.ask_triangles(wanted.triangles),
            budget_.ask_vertices(wanted.vertices)})
        if (over) return at(n, error_at("", *over));
    }
    return Done{};
  }
  Status within(std::size_t n, const std::optional<Note>& over) const {
    if (!over) return Done{};
    return at(n, error_at("", *over));
  }

  Status count_triangles(std::size_t n, double triangles) {
    return within(n, budget_.ask_triangles(built_.triangles += triangles));
  }

  // Once per mesh, for all its nodes.
  void note_winding(std::int32_t mesh, const BuiltMesh& built) {
    const std::optional<Note> turned = winding_note(built.report);
    if (turned && noted_.insert(mesh).second) notes_.push_back("mesh `" + built.mesh.name + "`: " + turned->message());
  }

  void note_refinement(const LevelNode& node, const BuiltMesh& built) {
    if (built.report.refined_from == 0) return;
    constexpr std::size_t kNamed = 3;
    if (refined_.count++ < kNamed) refined_.names += (refined_.names.empty() ? "`" : ", `") + node.name + "`";
    if (refined_.count > kNamed) refined_.more = " and " + with_commas(refined_.count - kNamed) + " more";
    refined_.from += built.report.refined_from;
    refined_.to += built.mesh.triangles.size();
  }
  // One note for all nodes.
  void say_refinement() {
    if (refined_.count == 0) return;
    notes_.push_back(refined_.names + refined_.more + ": " + with_commas(refined_.from) + " triangles refined to " +
                     with_commas(refined_.to) + " so that dents can show");
  }

  void say_placeholders() {
    if (placeholders_ == 0) return;
    const std::string more = placeholders_ == 1 ? "" : " and " + with_commas(placeholders_ - 1) + " more";
    notes_.push_back("`" + placeholder_ + "`" + more + ": no triangle with an area; left out as a placeholder");
  }

  // Whether the mesh built for one node's dents also suits another node.
  bool serves(const Baked& built, const Baked& wanted) const {
    if (built.dents == wanted.dents) return true;
    if (built.refined || !wanted.dents) return !built.refined;
    const Mesh& mesh = world_.meshes[built.touch];
    return !is_coarse(mesh, wanted.dents->radius(mesh));
  }

  Result<Baked> bake(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    const TouchShape shape = shape_of(n);
    Baked wanted;
    if (node.deformable) wanted.dents = dent_size(*node.deformable);
    std::vector<Baked>& known = baked_[static_cast<std::size_t>(node.mesh)][shape];
    for (const Baked& b : known)
      if (serves(b, wanted)) return b;

    const LevelMesh& mesh = level_.meshes[static_cast<std::size_t>(node.mesh)];
    progress_.say("preparing meshes, now `" + (mesh.name.empty() ? node.name : mesh.name) + "`", share_of(n));
    if (Status s = count_triangles(n, budget_.of(node.mesh).triangles); !s) return s.error();
    Result<BuiltMesh> built = build_mesh(mesh.name.empty() ? node.name : mesh.name, mesh.primitives, matrix_of(shape),
                                         {shape.crease_angle, wanted.dents, shape.touchable});
    if (!built) return around(n, built.error());
    note_winding(node.mesh, *built);
    note_refinement(node, *built);
    wanted.refined = built->report.refined_from != 0;
    if (wanted.refined)
      if (Status s = count_triangles(n, static_cast<double>(built->mesh.triangles.size())); !s) return s.error();
    if (shape.touchable)
      wanted.touch = world_.meshes.add(std::move(built->mesh));
    else
      for (std::uint32_t v = 0; v < built->draw.vertices.size(); ++v) built->draw.vertices[v].touch_vertex = v;
    wanted.draw = world_.draw_meshes.add(std::move(built->draw));
    known.push_back(wanted);
    return wanted;
  }

  Status device(std::size_t n) {
    if (!level_.nodes[n].device) return Done{};
    HapticDevice device = *level_.nodes[n].device;
    if (device.driver == DriverKind::kScript) {
      if (device.file.empty())
        return at(n, "its driver is `script` but `file` is missing", "name a .csv file, relative to the level");
      const Result<std::filesystem::path> file = confined_path(folder_, device.file);
      if (!file) return around(n, file.error());
      Result<const Path*> path = scripts_.read(*file, false);
      if (!path) return path.error();
      const auto [shared, is_new] = paths_.try_emplace(*path);
      if (is_new) shared->second = world_.paths.add(Path(**path));
      device.path = shared->second;
    }
    device.position = dvec3(motions_.world[n][3]);
    world_.registry.add<HapticDevice>(entities_[n], std::move(device));
    return Done{};
  }

  // A probe is moved by the device it names, else by the device on its own node, else by none.
  Status link_probe(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    if (!node.probe || !node.in_scene) return Done{};
    Probe& probe = world_.registry.get<Probe>(entities_[n]);
    if (node.probe_device.empty()) {
      if (node.device) probe.device = entities_[n];
      return Done{};
    }
    const auto found = by_name_.find(node.probe_device);
    if (found == by_name_.end() || !level_.nodes[found->second].device)
      return at(n, Error{"",
                         "PLIANT_probe/device names `" + node.probe_device +
                             "`, which is no node of this scene with PLIANT_haptic_device",
                         "correct the name, or add the device", "level.unknown_device"});
    probe.device = entities_[found->second];
    return Done{};
  }

  // Gives probes a surface mesh if there is a soft or rigid body.
  Status give_shells() {
    const auto is_body = [](const LevelNode& node) { return node.in_scene && (node.soft_body || node.rigid_body); };
    if (std::none_of(level_.nodes.begin(), level_.nodes.end(), is_body)) return Done{};
    for (std::size_t n = 0; n < level_.nodes.size(); ++n) {
      if (!level_.nodes[n].probe || !level_.nodes[n].in_scene) continue;
      Probe& probe = world_.registry.get<Probe>(entities_[n]);
      if (probe.meets == ProbeMeets::kSurfaces) continue;
      Result<Mesh> shell = probe_shell(probe);
      if (!shell) return shell.error();
      probe.shell = world_.meshes.add(std::move(*shell));
    }
    return Done{};
  }

  // A handle refers to its device by name; check that it exists.
  Status check_handle(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    if (!node.handle || !node.in_scene || node.handle->device.empty()) return Done{};
    const auto found = by_name_.find(node.handle->device);
    if (found != by_name_.end() && level_.nodes[found->second].device) return Done{};
    return at(n, Error{"",
                       "PLIANT_handle/device names `" + node.handle->device +
                           "`, which is no node of this scene with PLIANT_haptic_device",
                       "correct the name, or add the device", "level.unknown_device"});
  }

  const Level& level_;
  const std::filesystem::path folder_;
  World world_;
  std::vector<Entity> entities_;  // per node; kNoEntity: not in the scene
  LevelMotions motions_;
  ScriptLibrary scripts_;
  std::map<const Path*, Handle<Path>> paths_;                    // of scripts that move devices
  std::unordered_map<std::string, std::size_t> by_name_;         // first node in the scene with this name
  std::vector<std::map<TouchShape, std::vector<Baked>>> baked_;  // of each mesh of the level
  std::set<std::int32_t> noted_;                                 // meshes whose winding has been noted
  const LevelBudget budget_;
  MeshSize built_;           // so far; vertices of deformable surfaces
  double tetrahedra_ = 0.0;  // so far
  struct {
    std::size_t count = 0, from = 0, to = 0;  // nodes, triangles
    std::string names, more;
  } refined_;                       // refined meshes
  std::size_t placeholders_ = 0;    // nodes whose mesh has no surface
  std::string placeholder_;         // the first of them
  std::vector<std::string> notes_;  // of tetrahedra and winding, finer meshes
  LongWork progress_;
};

}  // namespace

Status check_level_size(const Level& level) {
  return Spawner(level).check_size();
}

Result<World> spawn_level(const Level& level, std::vector<std::string>* notes) {
  Spawner spawner(level);
  if (Status s = spawner.run(); !s) return s.error();
  if (notes) notes->insert(notes->end(), spawner.notes().begin(), spawner.notes().end());
  return spawner.take();
}

}  // namespace pliant
