#include "content/generate/tool_stage.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "content/author/presets.h"
#include "content/generate/instrument.h"
#include "content/generate/stage.h"
#include "content/generate/strokes.h"
#include "content/level_file.h"
#include "content/mesh/mesh_build.h"

namespace pliant::generate {
namespace {

// The mesh with the normals that the engine uses for rendering, so that every viewer shows the same edges. A vertex at
// a crease is duplicated for each smooth part.
Primitive with_normals(const std::string& name, const Net& net) {
  Primitive plain;
  for (const dvec3& p : net.position) plain.position.push_back(vec3(p));
  for (const uvec3& t : net.triangles) plain.index.insert(plain.index.end(), {t.x, t.y, t.z});
  const auto built = build_mesh(name, {&plain, 1}, mat4(1.0f));
  if (!built) return plain;  // loading rejects it and reports the reason
  const Mesh& mesh = built->mesh;
  Primitive primitive;
  std::vector<std::vector<std::uint32_t>> copies(mesh.vertex_count);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t v = mesh.triangles[t][corner];
      const vec3 normal = mesh.normal(t, corner);
      auto copy = std::ranges::find_if(copies[v], [&](std::uint32_t c) { return primitive.normal[c] == normal; });
      if (copy == copies[v].end()) {
        copies[v].push_back(static_cast<std::uint32_t>(primitive.position.size()));
        copy = copies[v].end() - 1;
        primitive.position.push_back(mesh.position(v));
        primitive.normal.push_back(normal);
      }
      primitive.index.push_back(*copy);
    }
  return primitive;
}

}  // namespace

Path lead(const std::vector<Waypoint>& waypoints, double rate) {
  Path path;
  const int rows = static_cast<int>(std::lround(waypoints.back().time * rate));
  for (int row = 0; row <= rows; ++row) {
    const double t = row / rate;
    dvec3 position = waypoints.front().position, turn = waypoints.front().turn;
    double grip = waypoints.front().grip;
    for (std::size_t i = 1; i < waypoints.size(); ++i) {
      const double s = smooth_step(waypoints[i - 1].time, waypoints[i].time, t);
      position += (waypoints[i].position - waypoints[i - 1].position) * s;
      turn += (waypoints[i].turn - waypoints[i - 1].turn) * s;
      grip += (waypoints[i].grip - waypoints[i - 1].grip) * s;
    }
    path.grips |= grip > 0.0;
    path.rows.push_back({t, position, glm::normalize(dquat(glm::radians(turn))), std::clamp(grip, 0.0, 1.0)});
  }
  return path;
}

Box around(dvec3 half) {
  return {vec3(-half), vec3(half)};
}

Solid rounded_box(dvec3 half, double radius) {
  return [half, radius](dvec3 p) {
    const dvec3 q = glm::abs(p) - (half - dvec3(radius));
    return length(glm::max(q, dvec3(0))) + std::min(std::max({q.x, q.y, q.z}), 0.0) - radius;
  };
}

Solid ball(double radius) {
  return [radius](dvec3 p) { return length(p) - radius; };
}

Solid torus(double major, double minor) {
  return [major, minor](dvec3 p) { return length(dvec2(length(dvec2(p.x, p.z)) - major, p.y)) - minor; };
}

double tapered(dvec3 p, dvec3 a, dvec3 b, double from, double to) {
  const double s = std::clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
  return length(p - a - s * (b - a)) - (from + s * (to - from));
}

std::int32_t add_tissue(Level& level, const std::string& preset, float thickness) {
  level.materials.push_back(look_of(*find_preset(preset), thickness));
  return static_cast<std::int32_t>(level.materials.size()) - 1;
}

LevelNode& add_shape(Level& level, const std::string& name, const Solid& solid, const Box& box, double cell,
                     std::int32_t material) {
  Primitive primitive = to_primitive(cover_by_net(solid, box, cell), solid);
  primitive.material = material;
  level.meshes.push_back({name, {std::move(primitive)}});
  LevelNode& node = add_node(level, name);
  node.mesh = static_cast<std::int32_t>(level.meshes.size()) - 1;
  return node;
}

LevelNode& add_mesh(Level& level, const std::string& name, const Net& net, std::int32_t material) {
  Primitive primitive = with_normals(name, net);
  primitive.material = material;
  level.meshes.push_back({name, {std::move(primitive)}});
  LevelNode& node = add_node(level, name);
  node.mesh = static_cast<std::int32_t>(level.meshes.size()) - 1;
  return node;
}

void add_fixed(Level& level, const std::string& name, dvec3 half, dvec3 at, double yaw, std::int32_t material) {
  LevelNode& node = add_shape(level, name, rounded_box(half, 0.004), around(half + dvec3(0.01)), 0.006, material);
  node.local.translation = vec3(at);
  node.local.rotation = quat(dquat(dvec3(0, glm::radians(yaw), 0)));
  node.rigid_body = RigidBody{};
  node.rigid_body->fixed = true;
}

void add_slab(Level& level, const std::string& name, dvec3 half, dvec3 at, std::int32_t material) {
  LevelNode& node = add_mesh(level, name, box_mesh(half), material);
  node.local.translation = vec3(at);
  node.rigid_body = RigidBody{};
  node.rigid_body->fixed = true;
}

LevelNode& add_soft(Level& level, const std::string& name, const Solid& solid, const Box& box, double net_cell,
                    double cell, double young, std::int32_t material) {
  LevelNode& node = add_shape(level, name, solid, box, net_cell, material);
  node.soft_body = SoftBody{};
  node.soft_body->young = young;
  node.soft_body->poisson = 0.4;
  node.soft_body->rayleigh = {0.5, 0.01};
  node.soft_body->cell = cell;
  return node;
}

HapticDevice script_device(const std::string& file, double max_force) {
  HapticDevice device;
  device.driver = DriverKind::kScript;
  device.file = file;
  device.max_force = max_force;
  return device;
}

void place(LevelNode& node, const Waypoint& at) {
  node.local.translation = vec3(at.position);
  node.local.rotation = quat(glm::normalize(dquat(glm::radians(at.turn))));
}

Status write_scene(const Level& level, const std::filesystem::path& folder) {
  return save_plain(level, folder / (level.name + ".glb"));
}

Status write_path(const std::vector<Waypoint>& path, const std::string& comment, const std::string& file,
                  const std::filesystem::path& folder, double rate) {
  return save_script(lead(path, rate), comment, folder / file);
}

}  // namespace pliant::generate
