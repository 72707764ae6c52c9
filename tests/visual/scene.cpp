#include "tests/visual/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pliant::test {
namespace {

// Vertices in the order of the parameter grid, which is near enough in space for zones.
World world_of(const std::string& name, std::vector<DrawVertex> vertices, std::vector<std::uint32_t> indices) {
  Mesh mesh;
  mesh.name = name;
  mesh.vertex_count = static_cast<std::uint32_t>(vertices.size());
  for (std::uint32_t i = 0; i < mesh.vertex_count; ++i) {
    DrawVertex& v = vertices[i];
    v.touch_vertex = i;
    mesh.px.push_back(v.position.x), mesh.py.push_back(v.position.y), mesh.pz.push_back(v.position.z);
    mesh.nx.push_back(v.normal.x), mesh.ny.push_back(v.normal.y), mesh.nz.push_back(v.normal.z);
    mesh.box.add(v.position);
  }
  const std::uint32_t zones = (mesh.vertex_count + kZoneSize - 1) / kZoneSize;
  mesh.zone_box.resize(zones, mesh.box);
  for (std::vector<float>* padded : {&mesh.px, &mesh.py, &mesh.pz, &mesh.nx, &mesh.ny, &mesh.nz})
    padded->resize(std::size_t{zones} * kZoneSize, 0.0f);
  for (std::size_t i = 0; i < indices.size(); i += 3)
    mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});

  World world;
  world.name = name;
  const Entity entity = world.registry.create();
  const std::uint32_t index_count = static_cast<std::uint32_t>(indices.size());
  Deformable deformable;
  deformable.mesh = world.meshes.add(std::move(mesh));
  world.registry.add<Name>(entity, {name});
  world.registry.add<Pose>(entity);
  world.registry.add<Deformable>(entity, deformable);
  world.registry.add<Drawable>(
      entity, {world.draw_meshes.add({std::move(vertices), std::move(indices), {{0, index_count, -1}}})});
  return world;
}

// Two triangles for each cell of a grid of `columns` x `rows` cells.
std::vector<std::uint32_t> grid_indices(std::uint32_t columns, std::uint32_t rows) {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
      indices.insert(indices.end(), {a, c, b, b, c, d});
    }
  return indices;
}

}  // namespace

HeadlessContext* context() {
  static Result<std::unique_ptr<HeadlessContext>> made = HeadlessContext::create();
  if (!made) return nullptr;
  (*made)->make_current();
  return made->get();
}

std::unique_ptr<Renderer> renderer_for(const World& world) {
  Result<std::unique_ptr<Renderer>> made = Renderer::create(world);
  if (!made) ADD_FAILURE() << made.error().message();
  if (made) (*made)->options().quality = PictureQuality::kLow;
  return made ? *std::move(made) : nullptr;
}

World sheet(std::uint32_t n) {
  std::vector<DrawVertex> vertices;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= 2 * n; ++i) {
      const vec2 uv(static_cast<float>(i) / static_cast<float>(2 * n), static_cast<float>(j) / static_cast<float>(n));
      vertices.push_back({.position = {2 * uv.x - 1, 0, uv.y - 0.5f}, .normal = {0, 1, 0}, .uv = uv});
    }
  return world_of("sheet", std::move(vertices), grid_indices(2 * n, n));
}

World sphere(std::uint32_t rows) {
  constexpr float kPi = std::numbers::pi_v<float>;
  std::vector<DrawVertex> vertices;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= 2 * rows; ++i) {
      const vec2 uv(static_cast<float>(i) / static_cast<float>(2 * rows),
                    static_cast<float>(j) / static_cast<float>(rows));
      const float polar = kPi * uv.y, turn = 2 * kPi * uv.x;
      const vec3 p(std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn));
      vertices.push_back({.position = p, .normal = p, .tangent = {std::cos(turn), 0, -std::sin(turn), 1}, .uv = uv});
    }
  return world_of("sphere", std::move(vertices), grid_indices(2 * rows, rows));
}

World soft_block(std::uint32_t n) {
  std::vector<DrawVertex> vertices;
  std::vector<std::uint32_t> indices;
  for (const vec3 out : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1)}) {
    // Columns go along u, rows along -v, and u x v points out.
    const vec3 u = out.y != 0 ? vec3(1, 0, 0) : cross(vec3(0, 1, 0), out), v = cross(out, u);
    const std::uint32_t base = static_cast<std::uint32_t>(vertices.size());
    for (std::uint32_t j = 0; j <= n; ++j)
      for (std::uint32_t i = 0; i <= n; ++i) {
        const vec2 uv = vec2(i, j) / static_cast<float>(n);
        const vec3 p = 0.5f * out + (uv.x - 0.5f) * u + (0.5f - uv.y) * v + vec3(0, 0.5f, 0);
        vertices.push_back({.position = p, .normal = out, .tangent = vec4(u, 1), .uv = uv});
      }
    for (const std::uint32_t index : grid_indices(n, n)) indices.push_back(base + index);
  }
  World world = world_of("block", std::move(vertices), std::move(indices));
  const Entity entity = object_of(world);
  TetMesh tets;
  for (int i = 0; i < 27; ++i) tets.nodes.push_back(dvec3(i % 3, i / 3 % 3, i / 9) * 0.5 - dvec3(0.5, 0, 0.5));
  tets.free_count = 27;
  // Each cell in six, around its diagonal from corner 0 to corner 7 (Kuhn).
  const int paths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
  for (int cell = 0; cell < 8; ++cell)
    for (const auto& path : paths) {
      auto node = [&](int corner) {
        const int x = (cell & 1) + (corner & 1), y = (cell >> 1 & 1) + (corner >> 1 & 1),
                  z = (cell >> 2) + (corner >> 2);
        return static_cast<std::uint32_t>(x + 3 * y + 9 * z);
      };
      tets.tets.push_back({node(0), node(path[0]), node(path[1]), node(7)});
    }
  SoftBody soft;
  soft.collision_mesh = world.registry.get<Deformable>(entity).mesh;
  soft.tets = world.tet_meshes.add(std::move(tets));
  world.registry.remove<Deformable>(entity);
  world.registry.add<SoftBody>(entity, soft);
  return world;
}

SoftSnapshot soft_snapshot_of(const World& world, const Where& where) {
  SoftSnapshot snapshot;
  for (auto [entity, soft] : world.registry.view<SoftBody>()) {
    const Mesh& mesh = world.meshes[soft.collision_mesh];
    SoftObjectSnapshot object;
    object.object = entity;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) object.position.push_back(where(mesh.position(v)));
    object.normal.resize(mesh.vertex_count, vec3(0));
    for (const uvec3 t : mesh.triangles) {
      const vec3 a = object.position[t.x];
      const vec3 n = cross(object.position[t.y] - a, object.position[t.z] - a);
      for (const std::uint32_t corner : {t.x, t.y, t.z}) object.normal[corner] += n;
    }
    for (vec3& n : object.normal) n = normalize(n);
    for (const dvec3 node : world.tet_meshes[soft.tets].nodes) object.nodes.push_back(where(vec3(node)));
    snapshot.objects.push_back(std::move(object));
  }
  return snapshot;
}

Entity add_probe(World& world, dvec3 position, double radius) {
  const Entity entity = world.registry.create();
  Probe probe;
  probe.radius = radius;
  probe.color = {0.9f, 0.05f, 0.05f};
  probe.position = position;
  probe.placed = true;
  world.registry.add<Probe>(entity, probe);
  return entity;
}

Entity object_of(const World& world) {
  for (auto [entity, deformable] : world.registry.view<Deformable>()) return entity;
  return kNoEntity;
}

const Mesh& mesh_of(const World& world) {
  return world.meshes[world.registry.get<Deformable>(object_of(world)).mesh];
}

Snapshot snapshot_of(const World& world, const StreamAt& stream) {
  const Mesh& mesh = mesh_of(world);
  ObjectSnapshot object;
  object.object = object_of(world);
  object.zone_count = mesh.zone_count();
  object.awake_vertices = mesh.vertex_count;
  for (std::uint32_t zone = 0; zone < mesh.zone_count(); ++zone) object.zones.push_back(zone);
  object.stream.resize(std::size_t{mesh.zone_count()} * kZoneSize, vec4(0));
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) object.stream[v] = stream(mesh.position(v), mesh.normal(v));
  Snapshot snapshot;
  snapshot.objects.push_back(std::move(object));
  return snapshot;
}

Snapshot awake_only(const World& world, Snapshot snapshot) {
  const Mesh& mesh = mesh_of(world);
  ObjectSnapshot& all = snapshot.objects[0];
  ObjectSnapshot awake;
  awake.object = all.object;
  for (std::uint32_t zone = 0; zone < all.zone_count; ++zone) {
    const auto begin = all.stream.begin() + zone * kZoneSize, end = begin + kZoneSize;
    if (std::all_of(begin, end, [](vec4 s) { return s == vec4(0); })) continue;
    awake.zones.push_back(zone);
    awake.stream.insert(awake.stream.end(), begin, end);
    awake.awake_vertices += mesh.zone_end(zone) - mesh.zone_begin(zone);
  }
  awake.zone_count = static_cast<std::uint32_t>(awake.zones.size());
  all = std::move(awake);
  return snapshot;
}

StreamAt dent(vec3 center, float depth, float reach) {
  return [=](vec3 position, vec3 normal) {
    const vec3 away = position - center;
    const float u = dot(away, away) / (reach * reach);
    if (u >= 1) return vec4(0);
    // f = (1-u)^3 (1-5u); df/dr = (2 r / R^2) df/du, along r; h = -depth f, correction -grad h in the surface.
    const float w = 1 - u, f = w * w * w * (1 - 5 * u), slope = -w * w * (3 * (1 - 5 * u) + 5 * w);
    vec3 gradient = depth * slope * 2.0f / (reach * reach) * away;
    gradient -= normal * dot(normal, gradient);
    return vec4(gradient, -depth * f);
  };
}

}  // namespace pliant::test
