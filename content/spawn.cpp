// Level -> World. Nodes become entities in order; meshes are built once for every way in which a node scales them.
#include <cmath>
#include <unordered_map>

#include "components/mass_properties.h"
#include "components/soft_body.h"
#include "content/device_use.h"
#include "content/exr.h"
#include "content/level.h"
#include "content/mesh_build.h"
#include "content/progress.h"
#include "content/script.h"
#include "content/spawn_soft.h"

namespace pliant {
namespace {

constexpr double kDefaultReach = 0.08;                        // [1] of the object's diagonal
constexpr double kFlat = 1e-9;                                // [1] of the diagonal cubed: no volume
constexpr std::size_t kMostTriangles = std::size_t{1} << 26;  // over all instances: a small file can name a mesh often

dmat4 matrix(const LocalTransform& local) {
  dmat4 m = glm::mat4_cast(glm::normalize(dquat(local.rotation)));
  for (int i = 0; i < 3; ++i) m[i] *= static_cast<double>(local.scale[i]);
  m[3] = glm::dvec4(dvec3(local.translation), 1.0);
  return m;
}

// The direction of v, or of the axis least along `avoid` and perpendicular to it where v has none.
dvec3 direction(dvec3 v, dvec3 avoid) {
  const double l = length(v);
  if (l > 0.0 && std::isfinite(l)) return v / l;
  const dvec3 axis = std::abs(avoid.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return normalize(axis - avoid * dot(axis, avoid));
}

// The rigid part of a node's frame, by Gram-Schmidt on its columns: exact where there is only rotation and scale;
// shear, mirroring and a scale of zero stay in what is left, Pose^-1 * world.
Pose rigid_part(const dmat4& world) {
  const dvec3 x = direction(dvec3(world[0]), dvec3(0));
  const dvec3 along_y(world[1]);
  const dvec3 y = direction(along_y - x * dot(x, along_y), x);
  return {dvec3(world[3]), glm::normalize(glm::quat_cast(dmat3(x, y, cross(x, y))))};
}

dmat4 inverse(const Pose& pose) {
  const dquat back = glm::conjugate(pose.rotation);
  dmat4 m = glm::mat4_cast(back);
  m[3] = glm::dvec4(back * -pose.position, 1.0);
  return m;
}

// A mesh as some node wants it. Nodes that bake the same frame into the same mesh share what was built.
struct Baked {
  bool touchable;
  mat4 to_object;
  Handle<Mesh> touch;
  Handle<DrawMesh> draw;
};

class Spawner {
 public:
  explicit Spawner(const Level& level) : level_(level), folder_(level.path.parent_path()) {}

  Status run() {
    world_.name = level_.name;
    world_.simulation = level_.simulation;
    world_.materials = level_.materials;
    world_.images = level_.images;
    if (Status s = environment(); !s) return s;
    entities_.assign(level_.nodes.size(), kNoEntity);
    matrices_.assign(level_.nodes.size(), dmat4(1.0));
    baked_.resize(level_.meshes.size());
    for (std::size_t n = 0; n < level_.nodes.size(); ++n)
      if (Status s = node(n); !s) return s;
    for (std::size_t n = 0; n < level_.nodes.size(); ++n)
      if (Status s = link_probe(n); !s) return s;
    for (std::size_t n = 0; n < level_.nodes.size(); ++n)
      if (Status s = check_handle(n); !s) return s;
    const std::vector<DeviceFault> shared = find_shared_devices(level_);
    if (!shared.empty()) return at(shared.front().node, shared.front().what);
    return Done{};
  }
  World take() { return std::move(world_); }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  Error at(std::size_t n, std::string what) const {
    return {level_.path.filename().string() + ": node `" + level_.nodes[n].name + "`", std::move(what)};
  }

  Status environment() {
    if (!level_.environment) return Done{};
    world_.environment.intensity = static_cast<float>(level_.environment->intensity);
    world_.environment.rotation = static_cast<float>(level_.environment->rotation);
    if (level_.environment->panorama.empty()) return Done{};
    Result<Panorama> panorama = load_panorama(folder_ / level_.environment->panorama, &notes_);
    if (!panorama) return panorama.error();
    world_.environment.panorama = std::move(*panorama);
    return Done{};
  }

  Status node(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    const auto parent = static_cast<std::size_t>(node.parent);
    ASSERT(node.parent < 0 || parent < n);
    matrices_[n] = (node.parent < 0 ? dmat4(1.0) : matrices_[parent]) * matrix(node.local);
    if (!node.in_scene) return Done{};

    Registry& registry = world_.registry;
    const Entity entity = entities_[n] = registry.create();
    world_.hierarchy.add(entity, node.parent < 0 ? kNoEntity : entities_[parent]);
    registry.add<Name>(entity, {node.name});
    registry.add<LocalTransform>(entity, node.local);
    registry.add<WorldTransform>(entity, {mat4(matrices_[n])});
    if (!by_name_.count(node.name)) by_name_[node.name] = n;
    if (node.light) registry.add<Light>(entity, *node.light);
    if (node.camera) registry.add<Camera>(entity, *node.camera);
    if (const std::string fault = soft_fault(node); !fault.empty()) return at(n, fault);
    if (node.handle) registry.add<Handle6>(entity, *node.handle);
    if (Status s = surface(n); !s) return s;
    if (Status s = device(n); !s) return s;
    if (node.probe) {
      const Pose pose = rigid_part(matrices_[n]);
      Probe& probe = registry.add<Probe>(entity, *node.probe);
      probe.position = probe.previous = pose.position;
      probe.rotation = pose.rotation;
    }
    return Done{};
  }

  // Drawable, and Deformable, SoftBody or RigidBody where the node is one.
  Status surface(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    if (node.soft_body) return soft_body(n);
    if (node.mesh < 0) {
      if (node.deformable)
        return at(n, "has PLIANT_deformable but no mesh; give the node a mesh, or remove the extension");
      return Done{};
    }
    if (!is_touched(node) && level_.meshes[static_cast<std::size_t>(node.mesh)].primitives.empty()) return Done{};
    const Pose pose = rigid_part(matrices_[n]);
    Result<Baked> baked = bake(n, mat4(inverse(pose) * matrices_[n]));
    if (!baked) return baked.error();
    world_.registry.add<Pose>(entities_[n], pose);
    world_.registry.add<Drawable>(entities_[n], {baked->draw});
    if (node.deformable) {
      Deformable& deformable = world_.registry.add<Deformable>(entities_[n], *node.deformable);
      deformable.mesh = baked->touch;
      deformable.field = world_.fields.add({});
      if (deformable.reach <= 0.0)
        deformable.reach = kDefaultReach * static_cast<double>(world_.meshes[deformable.mesh].box.diagonal());
    }
    if (node.rigid_body) return rigid_body(n, baked->touch);
    return Done{};
  }

  Status rigid_body(std::size_t n, Handle<Mesh> skin) {
    RigidBody& body = world_.registry.add<RigidBody>(entities_[n], *level_.nodes[n].rigid_body);
    body.skin = skin;
    const Mesh& mesh = world_.meshes[skin];
    const double box = std::pow(static_cast<double>(mesh.box.diagonal()), 3.0);
    if (body.fixed || mass_properties(mesh).volume > kFlat * box) return Done{};
    return at(n, "has PLIANT_rigid_body but its mesh encloses no volume; close the mesh, or set `fixed`");
  }

  static bool is_touched(const LevelNode& node) { return node.deformable || node.rigid_body; }

  // Flesh is never shared: which of its nodes are held is the node's own.
  Status soft_body(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    const LevelMesh* mesh = node.mesh < 0 ? nullptr : &level_.meshes[static_cast<std::size_t>(node.mesh)];
    if (mesh)
      if (Status s = count_triangles(n, *mesh); !s) return s;
    const Pose pose = rigid_part(matrices_[n]);
    progress_.say("preparing meshes, now `" + node.name + "`");
    Result<SoftParts> parts = make_soft_parts(node, mesh, mat4(inverse(pose) * matrices_[n]), folder_);
    if (!parts) return at(n, parts.error().message());
    for (const std::string& note : parts->notes) notes_.push_back(node.soft_body->mesh + ": " + note);
    world_.registry.add<Pose>(entities_[n], pose);
    SoftBody& body = world_.registry.add<SoftBody>(entities_[n], *node.soft_body);
    body.tets = world_.tet_meshes.add(std::move(parts->tets));
    body.skin = world_.meshes.add(std::move(parts->surface.mesh));
    world_.registry.add<Drawable>(entities_[n], {world_.draw_meshes.add(std::move(parts->surface.draw))});
    return Done{};
  }

  Status count_triangles(std::size_t n, const LevelMesh& mesh) {
    for (const Primitive& p : mesh.primitives) triangles_ += p.index.size() / 3;
    if (triangles_ <= kMostTriangles) return Done{};
    return at(n,
              "brings the level above 2^26 triangles; use fewer instances, or give them one scale so that they share");
  }

  Result<Baked> bake(std::size_t n, const mat4& to_object) {
    const LevelNode& node = level_.nodes[n];
    Baked wanted{is_touched(node), to_object, {}, {}};
    std::vector<Baked>& known = baked_[static_cast<std::size_t>(node.mesh)];
    for (const Baked& b : known)
      if (b.touchable == wanted.touchable && b.to_object == to_object) return b;

    const LevelMesh& mesh = level_.meshes[static_cast<std::size_t>(node.mesh)];
    progress_.say("preparing meshes, now `" + (mesh.name.empty() ? node.name : mesh.name) + "`");
    if (Status s = count_triangles(n, mesh); !s) return s.error();
    Result<BuiltMesh> built = build_mesh(mesh.name.empty() ? node.name : mesh.name, mesh.primitives, to_object);
    if (!built) return at(n, built.error().message());
    if (wanted.touchable)
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
    if (device.driver == Driver::kScript) {
      if (device.file.empty())
        return at(n, "its driver is `script` but `file` is missing; name a .csv file, relative to the level");
      Result<Path> path = load_script(folder_ / device.file);
      if (!path) return path.error();
      device.path = world_.paths.add(std::move(*path));
    }
    device.position = dvec3(matrices_[n][3]);
    world_.registry.add<HapticDevice>(entities_[n], std::move(device));
    return Done{};
  }

  // A probe is moved by the device it names, else by the device on its own node, else by nobody.
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
      return at(n,
                "PLIANT_probe/device names `" + node.probe_device +
                    "`, which is no node of this scene with PLIANT_haptic_device; correct the name, or add the device");
    probe.device = entities_[found->second];
    return Done{};
  }

  // Who reads a handle finds its device by name; it must be there.
  Status check_handle(std::size_t n) {
    const LevelNode& node = level_.nodes[n];
    if (!node.handle || !node.in_scene || node.handle->device.empty()) return Done{};
    const auto found = by_name_.find(node.handle->device);
    if (found != by_name_.end() && level_.nodes[found->second].device) return Done{};
    return at(n,
              "PLIANT_handle/device names `" + node.handle->device +
                  "`, which is no node of this scene with PLIANT_haptic_device; correct the name, or add the device");
  }

  const Level& level_;
  const std::filesystem::path folder_;
  World world_;
  std::vector<Entity> entities_;                          // of each node; kNoEntity: not in the scene
  std::vector<dmat4> matrices_;                           // node to world
  std::unordered_map<std::string, std::size_t> by_name_;  // first node in the scene with this name
  std::vector<std::vector<Baked>> baked_;                 // of each mesh of the level
  std::size_t triangles_ = 0;                             // built so far
  std::vector<std::string> notes_;                        // of panorama and tetrahedra
  Progress progress_;
};

}  // namespace

Result<World> spawn(const Level& level, std::vector<std::string>* notes) {
  Spawner spawner(level);
  if (Status s = spawner.run(); !s) return s.error();
  if (notes) notes->insert(notes->end(), spawner.notes().begin(), spawner.notes().end());
  return spawner.take();
}

}  // namespace pliant
