#include "systems/touch/collide/ridge.h"

#include <algorithm>
#include <limits>

#include "components/curved_patch.h"
#include "systems/touch/collide/section.h"

namespace pliant {
namespace {

constexpr int kDetours = 2;  // refinements of the way

struct WayPoint {
  std::uint32_t triangle;
  dvec3 p;  // [m]
};

// The place farthest from x on a way; far: none.
struct Highest {
  WayPoint at{kBorder, dvec3(0)};
  double far = std::numeric_limits<double>::infinity();
  SectionEdge edge{};  // on which it is
};

WayPoint point_in(const Mesh& mesh, std::uint32_t triangle, dvec3 p) {
  return {triangle, p + 1e-3 * (inside_triangle(mesh, triangle, dvec3(1.0 / 3)) - p)};
}

// The place of an edge of the section on the curved surface [m], and its derivative by the share of the edge.
struct EdgePlace {
  dvec3 p, along;
};
EdgePlace on_surface(const Mesh& mesh, const SectionEdge& at) {
  double b[3]{}, change[3]{};
  b[at.edge] = 1 - at.share;
  b[(at.edge + 1) % 3] = at.share;
  change[at.edge] = -1;
  change[(at.edge + 1) % 3] = 1;
  const CurvedPatch::Point point = curved_patch(mesh, at.triangle).at(b[1], b[2]);
  return {point.p, change[1] * point.pu + change[2] * point.pv};
}

// d/dx of the share at which the plane through both feet and x crosses an edge. The feet move by `from_moves`,
// `to_moves` [1] as x does.
dvec3 share_slope(const Mesh& mesh, const SectionEdge& at, dvec3 from, const dmat3& from_moves, dvec3 to,
                  const dmat3& to_moves, dvec3 x) {
  const uvec3 t = mesh.triangles[at.triangle];
  const dvec3 edge = dvec3(mesh.position(t[(at.edge + 1) % 3])) - dvec3(mesh.position(t[at.edge]));
  const dvec3 w = to - from, v = x - from, q = at.p - from, n = cross(w, v);
  const double rate = dot(n, edge);
  if (rate == 0.0) return dvec3(0);
  const auto by = [](const dmat3& moves, dvec3 g) { return glm::transpose(moves) * g; };
  return -(by(to_moves - from_moves, cross(v, q)) + by(dmat3(1.0) - from_moves, cross(q, w)) - by(from_moves, n)) /
         rate;
}

// Along the section by the plane through both and x.
Highest highest_between(const Mesh& mesh, const WayPoint& from, const WayPoint& to, dvec3 x, double within) {
  const uvec3 t = mesh.triangles[from.triangle];
  const dvec3 corner(mesh.position(t.x)),
      outward = cross(dvec3(mesh.position(t.y)) - corner, dvec3(mesh.position(t.z)) - corner), way = to.p - from.p;
  dvec3 across = cross(way, x - from.p);
  if (dot(cross(across, outward), way) < 0) across = -across;
  Highest highest;
  highest.far = 0.0;
  if (walk_section(mesh, from.triangle, to.triangle, from.p, across, [&](const SectionEdge& at) {
        const dvec3 p = on_surface(mesh, at).p;
        const double far = length(p - x);
        if (far > highest.far) highest = {{at.triangle, p}, far, at};
        return far < within;
      }))
    return highest;
  return {};
}

// Downhill from a place on a way, across the way.
WayPoint beside(const Mesh& mesh, WayPoint at, dvec3 way, dvec3 x) {
  WayPoint nearest = at;
  double least = length(at.p - x);
  for (const double sense : {1.0, -1.0}) {
    const double before = least;
    walk_section(mesh, at.triangle, kBorder, at.p, sense * way, [&](const SectionEdge& next) {
      const dvec3 p = on_surface(mesh, next).p;
      const double far = length(p - x);
      if (far > least * (1 + 1e-9)) return false;
      if (far < least) {
        least = far;
        nearest = {next.triangle, p};
      }
      return true;
    });
    if (least < before) break;
  }
  return nearest;
}

}  // namespace

Ridge ridge_between(const Mesh& mesh, const FootBlend& a, const FootBlend& b, dvec3 x, double radius) {
  const double most = std::min(radius - a.height, radius - b.height);
  const Ridge none_between{most, a.height > b.height ? -a.gradient : -b.gradient, x};
  if (a.main().triangle == b.main().triangle) return none_between;
  const auto end = [&](const Foot& foot) {
    return WayPoint{foot.triangle, inside_triangle(mesh, foot.triangle, foot.barycentric)};
  };
  const WayPoint from = end(a.main()), to = end(b.main());
  const double within = 1.5 * radius;
  Highest highest = highest_between(mesh, from, to, x, within);
  bool straight = true;
  // Beside the highest place of the straight way the surface may be nearer to x: the way goes there.
  for (int detour = 0; detour < kDetours && highest.at.triangle != kBorder; ++detour) {
    const WayPoint over = beside(mesh, highest.at, to.p - from.p, x), through = point_in(mesh, over.triangle, over.p);
    if (over.p == highest.at.p || through.triangle == from.triangle || through.triangle == to.triangle) break;
    const Highest first = highest_between(mesh, from, through, x, within),
                  second = highest_between(mesh, through, to, x, within),
                  &higher = first.far > second.far ? first : second;
    if (!(higher.far < highest.far)) break;
    highest = higher;
    straight = false;  // and near the lowest place across the way, which does not matter along it
  }
  const double depth = radius - highest.far;
  if (!(depth > 0)) return {};
  if (depth >= most || highest.at.triangle == kBorder) return none_between;
  const dvec3 outward = (highest.at.p - x) / highest.far;
  if (!straight) return {depth, outward, x};
  const auto moves = [&](const Foot& foot) {
    const uvec3 t = mesh.triangles[foot.triangle];
    dmat3 sum(0.0);
    for (int i = 0; i < 3; ++i)
      sum += glm::outerProduct(dvec3(mesh.position(t[i])), foot.shifts[static_cast<std::size_t>(i)]);
    return sum;
  };
  const dvec3 share = share_slope(mesh, highest.edge, from.p, moves(a.main()), to.p, moves(b.main()), x);
  return {depth, outward - dot(outward, on_surface(mesh, highest.edge).along) * share, x};
}

}  // namespace pliant
