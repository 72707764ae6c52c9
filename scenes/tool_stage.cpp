#include "scenes/tool_stage.h"

#include <algorithm>
#include <array>
#include <map>

#include "content/level/probe_shell.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/surface_samples.h"
#include "systems/prepare_world.h"
#include "systems/schedule.h"
#include "systems/tool/tool_step.h"

namespace pliant::scenes {
namespace {

Mesh built(const Primitive& primitive) {
  Result<BuiltMesh> result = build_mesh("surface", std::span(&primitive, 1), mat4(1));
  ASSERT(result.ok());
  return std::move(result->mesh);
}

// Embeds each vertex of the collision mesh at the node from which it was made.
std::vector<Embedding> embed(const TetMesh& tets, const Mesh& collision_mesh) {
  std::map<std::array<float, 3>, Embedding> at;
  for (std::uint32_t t = 0; t < tets.tets.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k) {
      Embedding place{t, {0, 0, 0, 0}};
      place.weight[k] = 1.0;
      const vec3 x(tets.nodes[tets.tets[t][k]]);
      at.try_emplace({x.x, x.y, x.z}, place);
    }
  std::vector<Embedding> all;
  for (std::uint32_t v = 0; v < collision_mesh.vertex_count; ++v)
    all.push_back(at.at({collision_mesh.px[v], collision_mesh.py[v], collision_mesh.pz[v]}));
  return all;
}

// Adds a separate unlimited device.
void hold(Registry& registry, Entity entity, const Handle6& handle, const Pose& pose) {
  registry.add(entity, handle);
  HapticDevice device;
  device.driver = DriverKind::kExternal;
  device.position = pose.position;
  device.rotation = pose.rotation;
  device.max_force = 1e9;
  device.max_slew = 1e12;
  registry.add(entity, device);
}

}  // namespace

Primitive border(const TetMesh& tets) {
  constexpr std::array<std::array<std::size_t, 3>, 4> kOutward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  std::map<std::array<std::uint32_t, 3>, std::pair<uvec3, int>> faces;
  for (const Tet& tet : tets.tets)
    for (const auto& f : kOutward) {
      std::array<std::uint32_t, 3> key{tet[f[0]], tet[f[1]], tet[f[2]]};
      const uvec3 face(key[0], key[1], key[2]);
      std::sort(key.begin(), key.end());
      const auto [found, is_new] = faces.try_emplace(key, face, 0);
      ++found->second.second;
    }
  Primitive p;
  for (const dvec3 x : tets.nodes) p.position.push_back(vec3(x));
  for (const auto& [key, face] : faces)
    if (face.second == 1) p.index.insert(p.index.end(), {face.first.x, face.first.y, face.first.z});
  return p;
}

Primitive box(dvec3 size, dvec3 centre) {
  Primitive p;
  for (int i = 0; i < 8; ++i)
    p.position.push_back(vec3(centre + 0.5 * size * dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  p.index = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
             2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return p;
}

ToolStage::ToolStage(double soft_step, double rate_hz) : Stage(rate_hz), soft_schedule_(pliant::soft_schedule()) {
  world.simulation.soft_step = soft_step;
}

Entity ToolStage::add_soft(TetMesh tets, SoftBody body, Pose pose, const Handle6* handle) {
  Mesh collision_mesh = built(border(tets));
  tets.embedding = embed(tets, collision_mesh);
  if (body.contact == SoftContact::kSplit) tets.samples = sample_surface(collision_mesh, tets);
  body.collision_mesh = world.meshes.add(std::move(collision_mesh));
  body.tets = world.tet_meshes.add(std::move(tets));
  const Entity entity = world.registry.create();
  world.registry.add(entity, Name{"soft"});
  world.registry.add(entity, pose);
  world.registry.add(entity, body);
  if (handle) hold(world.registry, entity, *handle, pose);
  return entity;
}

Entity ToolStage::add_rigid(const Primitive& primitive, RigidBody body, Pose pose, const Handle6* handle) {
  body.collision_mesh = world.meshes.add(built(primitive));
  const Entity entity = world.registry.create();
  world.registry.add(entity, Name{"rigid"});
  world.registry.add(entity, pose);
  world.registry.add(entity, body);
  if (handle) hold(world.registry, entity, *handle, pose);
  return entity;
}

void ToolStage::prepare() {
  for (auto [entity, probe] : world.registry.view<Probe>()) {
    if (probe.meets == ProbeMeets::kSurfaces) continue;
    Result<Mesh> shell = probe_shell(probe);
    ASSERT(shell.ok());
    probe.shell = world.meshes.add(std::move(*shell));
  }
  ASSERT(prepare_world(world).ok());
}

void ToolStage::step() {
  run_soft_step(soft_schedule_, world, {steps_, soft_step(), static_cast<double>(steps_) * soft_step()});
  ++steps_;
}

void ToolStage::run(double seconds) {
  const double end = time() + seconds - 0.5 * dt();
  while (time() < end) {
    while (static_cast<double>(steps_) * soft_step() <= time() + 1e-9) step();
    tick();
  }
}

void ToolStage::lead(Entity tool, dvec3 to, double seconds, const std::function<void()>& each) {
  const dvec3 from = device_of(tool).position;
  const int ticks = std::max(1, static_cast<int>(std::lround(seconds / dt())));
  for (int i = 1; i <= ticks; ++i) {
    device_of(tool).position = from + (to - from) * (double(i) / ticks);
    run(dt());
    if (each) each();
  }
}

Body& ToolStage::body(Entity entity) {
  for (const std::unique_ptr<Body>& candidate : soft().bodies)
    if (candidate->entity == entity) return *candidate;
  ASSERT(false && "no such body");
  std::abort();
}

dvec3 ToolStage::contact_force(Entity on, Entity other) {
  dvec3 sum(0);
  for (const ContactPoint& contact : soft().contacts) {
    const Entity a = soft().bodies[contact.body_a]->entity, b = soft().bodies[contact.body_b]->entity;
    if (a == on && b == other) sum += contact.axes * contact.impulse;
    if (b == on && a == other) sum -= contact.axes * contact.impulse;
  }
  return sum / soft_step();
}

double ToolStage::kinetic_energy() {
  double sum = 0.0;
  for (const std::uint32_t i : soft().moving) {
    const auto* tissue = soft().bodies[i]->as_tissue();
    if (!tissue) continue;
    for (std::size_t n = 0; n < tissue->tissue().mass().size(); ++n) {
      const dvec3 v = tissue->tissue().velocity()[n];
      sum += 0.5 * tissue->tissue().mass()[n] * dot(v, v);
    }
  }
  return sum;
}

double ToolStage::elastic_energy() {
  double sum = 0.0;
  for (const std::uint32_t i : soft().moving)
    if (const auto* tissue = soft().bodies[i]->as_tissue()) sum += tissue->tissue().elastic_energy();
  return sum;
}

}  // namespace pliant::scenes
