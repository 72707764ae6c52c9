#include "systems/soft/collide/surface_walk.h"

#include <algorithm>

namespace pliant {
namespace {

constexpr int kMostWalked = 16;      // triangles crossed; a distance of an edge or two needs fewer
constexpr double kWalkCrease = 0.5;  // [1] cosine between triangles: a surface ends at sharper edges

struct Facet {
  uvec3 corners;
  dvec3 along, aside, normal;  // [m] two edges from the first corner; their cross product [m2]
};

Facet facet_at(const Body& body, std::uint32_t triangle) {
  const uvec3 c = body.collision_mesh->triangles[triangle];
  const std::vector<dvec3>& x = body.surface_position;
  const dvec3 e = x[c.y] - x[c.x], f = x[c.z] - x[c.x];
  return {c, e, f, cross(e, f)};
}

// The vector rotated into the facet's plane, with its length kept.
dvec3 laid_flat(dvec3 by, const Facet& facet) {
  const dvec3 flat = by - dot(by, facet.normal) / dot(facet.normal, facet.normal) * facet.normal;
  const double size = length(flat);
  return size > 0.0 ? length(by) / size * flat : dvec3(0.0);
}

}  // namespace

std::optional<SurfacePoint> walk(const Body& body, SurfacePoint p, dvec3 by) {
  for (int gone = 0; gone < kMostWalked; ++gone) {
    const Facet facet = facet_at(body, p.triangle);
    const double nn = dot(facet.normal, facet.normal);
    if (!(nn > 0.0)) return {};
    by = laid_flat(by, facet);
    const double y = dot(cross(by, facet.aside), facet.normal) / nn, z = dot(cross(facet.along, by), facet.normal) / nn;
    const dvec3 way(-y - z, y, z);  // of the barycentrics
    double share = 1.0;
    int left_behind = -1;  // the corner opposite to the edge where the path leaves
    for (int i = 0; i < 3; ++i) {
      if (!(p.barycentric[i] + share * way[i] < 0.0)) continue;
      share = std::max(0.0, -p.barycentric[i] / way[i]);
      left_behind = i;
    }
    p.barycentric += share * way;
    p.position += share * by;
    if (left_behind < 0) return p;

    const std::uint32_t next = body.collision_mesh->across[p.triangle][(left_behind + 1) % 3];
    if (next == kBorder) return {};
    const Facet beyond = facet_at(body, next);
    if (!(dot(facet.normal, beyond.normal) > kWalkCrease * length(facet.normal) * length(beyond.normal))) return {};
    dvec3 there(0.0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (i != left_behind && beyond.corners[j] == facet.corners[i]) there[j] = std::max(0.0, p.barycentric[i]);
    const double sum = there.x + there.y + there.z;
    if (!(sum > 0.0)) return {};  // neighbours without a common edge: not a surface
    p.triangle = next;
    p.barycentric = there / sum;
    by *= 1.0 - share;
  }
  return {};
}

}  // namespace pliant
