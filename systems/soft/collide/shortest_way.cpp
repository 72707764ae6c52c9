#include "systems/soft/collide/shortest_way.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr double kBulge = 1e-3;          // [diagonals] tolerance of a vertex in front of a face: rounding, flat caps
constexpr double kMostTests = 5e7;       // faces times vertices; larger meshes count as not convex
constexpr double kMostEdgePairs = 1e5;   // above it, normals are dense
constexpr double kParallelEdges = 1e-6;  // [1] squared sine below which two edges give no axis
constexpr double kShorter = 1e-6;        // [1] relative improvement required to replace an earlier axis

struct Extent {
  double low = 1e300, high = -1e300;  // [m]
};

Extent extent(const CollisionMesh& collision_mesh, dvec3 axis) {
  Extent out;
  for (std::uint32_t v = 0; v < collision_mesh.mesh().vertex_count; ++v) {
    const double at = dot(axis, collision_mesh.vertex(v).x);
    out.low = std::min(out.low, at), out.high = std::max(out.high, at);
  }
  return out;
}

bool convex(const CollisionMesh& collision_mesh) {
  const Mesh& mesh = collision_mesh.mesh();
  if (!mesh.closed || double(mesh.triangles.size()) * double(mesh.vertex_count) > kMostTests) return false;
  const double bulge = kBulge * static_cast<double>(mesh.box.diagonal());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const dvec3 n = collision_mesh.normal(t);
    if (n != dvec3(0.0) &&
        extent(collision_mesh, n).high > dot(n, collision_mesh.vertex(mesh.triangles[t].x).x) + bulge)
      return false;
  }
  return true;
}

// The shortest way so far.
struct Way {
  const CollisionMesh& a;
  const CollisionMesh& b;
  double length = 1e300;  // [m]
  dvec3 direction{0};
  void consider(dvec3 axis) {  // of a, out of b
    const double needed = extent(b, axis).high - extent(a, axis).low;
    if (needed < (1.0 - kShorter) * length) length = needed, direction = axis;
  }
};

dvec3 along(const CollisionMesh& collision_mesh, const CollisionEdge& edge) {
  return collision_mesh.vertex(edge.to).x - collision_mesh.vertex(edge.from).x;
}

void consider_edges(Way& way) {
  if (double(way.a.edges().size()) * double(way.b.edges().size()) > kMostEdgePairs) return;
  for (const CollisionEdge& of_a : way.a.edges())
    for (const CollisionEdge& of_b : way.b.edges()) {
      const dvec3 e = along(way.a, of_a), f = along(way.b, of_b), n = cross(e, f);
      if (!(dot(n, n) > kParallelEdges * dot(e, e) * dot(f, f))) continue;
      way.consider(normalize(n));
      way.consider(-normalize(n));
    }
}

}  // namespace

std::optional<dvec3> shortest_way(const CollisionMesh& a, const CollisionMesh& b) {
  const double tests = double(a.mesh().triangles.size() + b.mesh().triangles.size()) *
                       double(a.mesh().vertex_count + b.mesh().vertex_count);
  if (tests > kMostTests || !convex(a) || !convex(b)) return {};
  Way way{a, b};
  for (std::uint32_t t = 0; t < b.mesh().triangles.size(); ++t)
    if (b.normal(t) != dvec3(0.0)) way.consider(b.normal(t));
  for (std::uint32_t t = 0; t < a.mesh().triangles.size(); ++t)
    if (a.normal(t) != dvec3(0.0)) way.consider(-a.normal(t));
  consider_edges(way);
  if (!(way.length > 0.0)) return {};
  return way.direction;
}

}  // namespace pliant
