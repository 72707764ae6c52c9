#include "engine/session/object_shape.h"

#include "engine/session/source_place.h"

namespace pliant {
namespace {

// For each vertex of the collision mesh its first source vertex; kBorder: created by refinement.
std::vector<std::uint32_t> first_sources(const Mesh& mesh) {
  std::vector<std::uint32_t> of_touch(mesh.vertex_count, kBorder);
  for (std::size_t i = mesh.of_source.size(); i-- > 0;)
    if (mesh.of_source[i] != kBorder) of_touch[mesh.of_source[i]] = static_cast<std::uint32_t>(i);
  return of_touch;
}

std::vector<uvec3> triangles_of(const Mesh& mesh) {
  const std::vector<std::uint32_t> source = first_sources(mesh);
  std::vector<uvec3> out;
  for (const uvec3& t : mesh.triangles) out.emplace_back(source[t.x], source[t.y], source[t.z]);
  return out;
}

}  // namespace

const Mesh* collision_mesh_of(const World& world, Entity entity) {
  const Registry& all = world.registry;
  if (const Deformable* surface = all.find<Deformable>(entity)) return &world.meshes[surface->mesh];
  if (const SoftBody* body = all.find<SoftBody>(entity)) return &world.meshes[body->collision_mesh];
  if (const RigidBody* body = all.find<RigidBody>(entity)) return &world.meshes[body->collision_mesh];
  return nullptr;
}

ObjectShape::ObjectShape(const Mesh& mesh, const LevelMesh* given)
    : mesh_(mesh), triangles_(given ? source_triangles(*given) : triangles_of(mesh)) {
  const auto known = [&](std::uint32_t v) { return v < mesh.of_source.size() && mesh.of_source[v] != kBorder; };
  for (uvec3& t : triangles_) {
    touched_.push_back(known(t.x) && known(t.y) && known(t.z));
    if (!touched_.back()) continue;
    dvec3 corner[3], outward(0);
    for (int k = 0; k < 3; ++k) {
      corner[k] = dvec3(mesh.position(mesh.of_source[t[k]]));
      outward += dvec3(mesh.normal(mesh.of_source[t[k]]));
    }
    if (dot(cross(corner[1] - corner[0], corner[2] - corner[0]), outward) < 0.0) std::swap(t.y, t.z);
  }
}

ObjectShape::Place ObjectShape::place(std::uint32_t triangle, dvec3 barycentric) {
  return place(mesh_.triangles[triangle], barycentric);
}

ObjectShape::Place ObjectShape::place(uvec3 vertices, dvec3 barycentric) {
  if (!rest_) {
    std::vector<dvec3> positions(mesh_.of_source.size(), dvec3(0));
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (mesh_.of_source[i] != kBorder) positions[i] = dvec3(mesh_.position(mesh_.of_source[i]));
    rest_.emplace(std::move(positions), triangles_, touched_);
  }
  dvec3 x(0);
  for (int k = 0; k < 3; ++k) x += barycentric[k] * dvec3(mesh_.position(vertices[k]));
  const TrianglePlace near = rest_->closest(x, std::numeric_limits<double>::infinity());
  if (!near.found()) return {};
  int nearest = 0;
  for (int k = 1; k < 3; ++k)
    if (length(rest_->corner(near.triangle, k) - x) < length(rest_->corner(near.triangle, nearest) - x)) nearest = k;
  return {near.triangle, triangles_[near.triangle][nearest]};
}

}  // namespace pliant
