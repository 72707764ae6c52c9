// A scene is a Level built by code (pliant/scene.h).
#include "pliant/scene.h"

#include "content/level/level.h"

namespace pliant {
namespace {

LevelNode placed(const std::string& name, const Placement& placement) {
  LevelNode node;
  node.name = name;
  node.local = {vec3(placement.position), quat(placement.rotation), vec3(placement.scale)};
  return node;
}

LevelNode with_mesh(Level& level, const std::string& name, MeshData mesh, const Placement& placement) {
  LevelNode node = placed(name, placement);
  node.mesh = static_cast<std::int32_t>(level.meshes.size());
  Primitive primitive;
  primitive.position = std::move(mesh.position);
  primitive.normal = std::move(mesh.normal);
  primitive.uv = std::move(mesh.uv);
  primitive.stiffness = std::move(mesh.stiffness);
  primitive.friction = std::move(mesh.friction);
  primitive.damping = std::move(mesh.damping);
  primitive.relaxation = std::move(mesh.relaxation);
  primitive.pinned = std::move(mesh.pinned);
  primitive.handle = std::move(mesh.handle);
  primitive.index = std::move(mesh.index);
  level.meshes.push_back({name, {std::move(primitive)}});
  return node;
}

template <class Component, class Parameters>
Component made_of(const Parameters& parameters) {
  Component component;
  static_cast<Parameters&>(component) = parameters;
  return component;
}

}  // namespace

Scene::Scene(std::string name) : level_(std::make_unique<Level>()) {
  level_->name = std::move(name);
  level_->path = level_->name;
}
Scene::Scene(const Level& level) : level_(std::make_unique<Level>(level)) {}
Scene::Scene(const Scene& other) : level_(std::make_unique<Level>(*other.level_)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene& other) {
  if (this != &other) level_ = std::make_unique<Level>(*other.level_);
  return *this;
}
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

Simulation& Scene::simulation() & {
  return level_->simulation;
}

void Scene::add_surface(const std::string& name, MeshData mesh, const DeformableParameters& parameters,
                        const Placement& placement) {
  LevelNode node = with_mesh(*level_, name, std::move(mesh), placement);
  node.deformable = made_of<Deformable>(parameters);
  level_->nodes.push_back(std::move(node));
}

void Scene::add_soft_body(const std::string& name, MeshData mesh, const SoftBodyParameters& parameters,
                          const Placement& placement) {
  LevelNode node = with_mesh(*level_, name, std::move(mesh), placement);
  node.soft_body = made_of<SoftBody>(parameters);
  level_->nodes.push_back(std::move(node));
}

void Scene::add_rigid_body(const std::string& name, MeshData mesh, const RigidBodyParameters& parameters,
                           const Placement& placement) {
  LevelNode node = with_mesh(*level_, name, std::move(mesh), placement);
  node.rigid_body = made_of<RigidBody>(parameters);
  level_->nodes.push_back(std::move(node));
}

Status Scene::add_handle(const std::string& body, const HandleParameters& parameters, const DeviceParameters& device) {
  for (LevelNode& node : level_->nodes) {
    if (node.name != body) continue;
    if (!node.soft_body && !node.rigid_body)
      return Error{"handle of `" + body + "`", "it is neither a soft nor a rigid body", "only those are held"};
    node.handle = made_of<Handle6>(parameters);
    node.handle->device = body;
    node.device = made_of<HapticDevice>(device);
    return Done{};
  }
  return Error{"handle of `" + body + "`", "the scene has no body of that name", "add it first"};
}

void Scene::add_probe(const std::string& name, const ProbeParameters& parameters, const DeviceParameters& device,
                      const Placement& placement) {
  LevelNode node = placed(name, placement);
  node.probe = made_of<Probe>(parameters);
  node.device = made_of<HapticDevice>(device);
  node.probe_device = name;
  level_->nodes.push_back(std::move(node));
}

void Scene::add_effect(const std::string& name, const EffectParameters& parameters, const Placement& placement,
                       Path path) {
  LevelNode node = placed(name, placement);
  node.effect = made_of<Effect>(parameters);
  node.effect_path = std::move(path);
  level_->nodes.push_back(std::move(node));
}

void Scene::add_joint(const std::string& name, const JointParameters& parameters, const Placement& placement) {
  LevelNode node = placed(name, placement);
  node.joint = made_of<Joint>(parameters);
  level_->nodes.push_back(std::move(node));
}

}  // namespace pliant
