#include "content/mesh/finer_vertices.h"

namespace pliant {
namespace {

bool is_corner(vec2 at, int corner) {
  return at == (corner == 0 ? vec2(0, 0) : corner == 1 ? vec2(1, 0) : vec2(0, 1));
}

}  // namespace

PatchVertices::PatchVertices(const Mesh& mesh) : mesh_(mesh) {
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) position_.push_back(mesh.position(v));
}

std::uint32_t PatchVertices::add(std::uint32_t triangle, vec2 at, int edge) {
  const CurvedPatch patch = curved_patch(mesh_, triangle);
  position_.push_back(vec3(patch.at(at.x, at.y).p) + vec3(0.0f));
  dvec3 normal = patch_normal(triangle, patch, at);
  bool own = false;
  if (edge >= 0) {
    own = mesh_.is_crease(triangle, edge);
    const std::uint32_t other = mesh_.across[triangle][edge];
    if (!own && other != kBorder)
      normal += patch_normal(other, curved_patch(mesh_, other), seen_from(other, triangle, edge, at));
  }
  const double size = length(normal);
  normal_.push_back(size > 1e-6 ? vec3(normal / size) : vec3(patch_normal(triangle, patch, at)));
  own_.push_back(own);
  return static_cast<std::uint32_t>(position_.size() - 1);
}

// A point on an edge, in barycentric coordinates of the neighbour triangle.
vec2 PatchVertices::seen_from(std::uint32_t other, std::uint32_t triangle, int edge, vec2 at) const {
  const float weight[3] = {1.0f - at.x - at.y, at.x, at.y};
  vec2 out(0);
  for (int k = 1; k < 3; ++k)
    for (const int end : {edge, (edge + 1) % 3})
      if (mesh_.triangles[other][k] == mesh_.triangles[triangle][end]) out[k - 1] = weight[end];
  return out;
}

dvec3 PatchVertices::patch_normal(std::uint32_t triangle, const CurvedPatch& patch, vec2 at) const {
  const double u = static_cast<double>(at.x), v = static_cast<double>(at.y);
  const CurvedPatch::Point point = patch.at(u, v);
  const dvec3 n = cross(point.pu, point.pv), mean = (1 - u - v) * dvec3(mesh_.normal(triangle, 0)) +
                                                    u * dvec3(mesh_.normal(triangle, 1)) +
                                                    v * dvec3(mesh_.normal(triangle, 2));
  const double size = length(n), usual = length(cross(patch.b[1] - patch.b[0], patch.b[2] - patch.b[0]));
  if (size > 1e-3 * usual && dot(n, mean) > 0.0) return n / size;
  return length(mean) > 1e-6 ? mean / length(mean) : dvec3(mesh_.normal(triangle, 0));  // bad normals fold a patch
}

vec3 PatchVertices::normal_at(std::uint32_t triangle, std::uint32_t vertex, vec2 at, const CurvedPatch& patch) const {
  if (vertex >= mesh_.vertex_count) {
    const std::size_t added = vertex - mesh_.vertex_count;
    return own_[added] ? vec3(patch_normal(triangle, patch, at)) : normal_[added];
  }
  for (int corner = 0; corner < 2; ++corner)
    if (is_corner(at, corner)) return mesh_.normal(triangle, corner);
  return mesh_.normal(triangle, 2);
}

}  // namespace pliant
