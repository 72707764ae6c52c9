#include "systems/soft/collide/smooth_shape.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/collide/collision_mesh.h"
#include "systems/soft/collide/farthest_axis.h"

namespace pliant {
namespace {

// Two tangents for a normal.
dmat3 tangent_frame(dvec3 n) {
  const dvec3 along = farthest_axis(n);
  const dvec3 t = normalize(along - dot(along, n) * n);
  return dmat3(n, t, cross(n, t));
}

// N. Max, Weights for computing vertex normals from facet normals, Journal of Graphics Tools 4 (1999).
std::vector<dvec3> normals_by_max(const Mesh& mesh) {
  std::vector<dvec3> normal(mesh.vertex_count, dvec3(0.0));
  for (const uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const dvec3 x(mesh.position(t[i]));
      const dvec3 e = dvec3(mesh.position(t[(i + 1) % 3])) - x, f = dvec3(mesh.position(t[(i + 2) % 3])) - x;
      const double weight = dot(e, e) * dot(f, f);
      if (weight > 0.0) normal[t[i]] += cross(e, f) / weight;
    }
  return normal;
}

}  // namespace

std::vector<dmat3> shape_operators(const Mesh& mesh, std::span<const CollisionEdge> edges,
                                   const std::vector<dvec3>& normal) {
  struct Sums {
    dmat2 steps{0}, turns{0};  // of tangential steps times steps, turns times steps
  };
  const std::uint32_t count = mesh.vertex_count;
  std::vector<Sums> sums(count);
  std::vector<dmat3> frame(count), own(count, dmat3(0.0));
  for (std::uint32_t v = 0; v < count; ++v) frame[v] = tangent_frame(normal[v]);
  for (const CollisionEdge& edge : edges)
    for (const auto& [from, to] : {std::pair(edge.from, edge.to), std::pair(edge.to, edge.from)}) {
      const dvec3 d = (dvec3(mesh.position(to)) - dvec3(mesh.position(from))) * frame[from];
      const dvec3 n = (normal[to] - normal[from]) * frame[from];
      const dvec2 step(d.y, d.z), turn(n.y, n.z);
      const double weight = 1.0 / std::max(dot(step, step), 1e-30);
      sums[from].steps += weight * glm::outerProduct(step, step);
      sums[from].turns += weight * glm::outerProduct(turn, step);
    }
  for (std::uint32_t v = 0; v < count; ++v) {
    const dmat2& steps = sums[v].steps;
    const double trace = steps[0][0] + steps[1][1];
    if (!(glm::determinant(steps) > 1e-6 * trace * trace)) continue;
    const dmat2 k = sums[v].turns * glm::inverse(steps);
    const double off = 0.5 * (k[0][1] + k[1][0]);
    const dmat3 local(0, 0, 0, 0, k[0][0], off, 0, off, k[1][1]);
    own[v] = frame[v] * local * glm::transpose(frame[v]);
  }
  return own;
}

void average_over_neighbours(std::span<const CollisionEdge> edges, const std::vector<std::uint8_t>& smooth,
                             std::vector<dmat3>& bend) {
  const std::vector<dmat3> own = bend;
  std::vector<double> weight(bend.size(), 1.0);
  for (const CollisionEdge& edge : edges) {
    if (!smooth[edge.from] || !smooth[edge.to]) continue;
    bend[edge.from] += own[edge.to], bend[edge.to] += own[edge.from];
    ++weight[edge.from], ++weight[edge.to];
  }
  for (std::uint32_t v = 0; v < bend.size(); ++v) bend[v] /= weight[v];
}

SmoothShape::SmoothShape(const Mesh& mesh, std::span<const CollisionEdge> edges,
                         const std::vector<std::uint8_t>& smooth_vertices)
    : normal(normals_by_max(mesh)), smooth(smooth_vertices) {
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const double size = length(normal[v]);
    if (!(size > 0.0)) smooth[v] = 0;
    normal[v] = smooth[v] ? normal[v] / size : dvec3(0.0);
  }
  bend = shape_operators(mesh, edges, normal);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const double mean = 0.5 * (bend[v][0][0] + bend[v][1][1] + bend[v][2][2]);
    bend[v] = smooth[v] ? bend[v] + mean * glm::outerProduct(normal[v], normal[v]) : dmat3(0.0);
  }
  average_over_neighbours(edges, smooth, bend);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) bulge = std::max(bulge, rise(mesh, t, dvec3(1.0 / 3.0)));
}

double SmoothShape::rise(const Mesh& mesh, std::uint32_t triangle, dvec3 w) const {
  const uvec3 c = mesh.triangles[triangle];
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t from = c[i], to = c[(i + 1) % 3];
    if (!smooth[from] || !smooth[to]) continue;
    const dvec3 along = dvec3(mesh.position(to)) - dvec3(mesh.position(from));
    sum += 0.5 * w[i] * w[(i + 1) % 3] * dot(normal[to] - normal[from], along);
  }
  return sum;
}

}  // namespace pliant
