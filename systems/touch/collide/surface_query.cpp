#include "systems/touch/collide/surface_query.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/touch/collide/triangle_tree.h"

namespace pliant {
namespace {

void keep_nearer(SurfaceFoot& best, const SurfaceFoot& candidate) {
  if (candidate.valid() && (!best.valid() || candidate.distance() < best.distance())) best = candidate;
}

// The edge opposite the most negative barycentric. Edges run from corner i to i+1, opposite corner (i+2)%3.
int edge_to_cross(dvec3 b) {
  const int corner = b.x < b.y ? (b.x < b.z ? 0 : 2) : (b.y < b.z ? 1 : 2);
  return (corner + 1) % 3;
}

// Tolerance on barycentrics at which the walk stops; edges belong to both sides.
constexpr double kWalkInside = -1e-9;

}  // namespace

// A virtual vertex more than this many times as far as the closest point is on another part of the surface.
constexpr double kSamePart = 2.0;

SurfaceFoot prefer_virtual(const SurfaceFoot& vertex, const SurfaceFoot& closest) {
  return vertex.valid() && vertex.distance() <= kSamePart * closest.distance() ? vertex : closest;
}

namespace {

// Where normals are smooth, a virtual vertex is hardly farther than the closest point. Triangles within this many times
// the closest distance are kept in a list; a second pass is made only if that was not enough.
constexpr double kBand = 1.02;

struct NearTriangles {
  struct Near {
    std::uint32_t triangle;
    float distance2;  // [m2] single precision
  };
  std::array<Near, 96> list;
  std::uint32_t count = 0;
  bool complete = true;  // the list has everything within the last limit

  void add(std::uint32_t triangle, float distance2, float limit) {
    if (count == list.size()) {
      std::uint32_t kept = 0;
      for (const Near& near : list)
        if (near.distance2 <= limit) list[kept++] = near;
      count = kept;
    }
    if (count < list.size())
      list[count++] = {triangle, distance2};
    else
      complete = false;
  }
};

// Searches one triangle for a nearer virtual vertex. Heights are distances to points of the triangle, so the distance
// to it is a lower bound.
void try_virtual(const Mesh& mesh, dvec3 x, std::uint32_t triangle, double farthest, SurfaceFoot& best) {
  const double distance2 = closest_on_triangle(mesh, triangle, x).distance2;
  const double bound = best.valid() ? best.distance() : farthest;
  if (distance2 > bound * bound * 1.0000001 || !may_have_virtual_vertex(mesh, triangle, x, distance2)) return;
  const SurfaceFoot p = virtual_vertex(mesh, triangle, x);
  if (p.valid() && p.distance() <= farthest) keep_nearer(best, p);
}

}  // namespace

SurfaceFoot nearest(const Mesh& mesh, dvec3 x, double within) {
  const double round = rounding(mesh, x);
  FlatPoint flat;
  double distance = within;
  float limit = distance2_limit(distance, round), band = distance2_limit(kBand * distance, round);
  NearTriangles near;
  TriangleDistances d2;
  visit_runs_near(
      mesh, x, [&] { return kBand * distance; },
      [&](std::uint32_t first, std::uint32_t count) {
        triangle_distances2(mesh, first, count, x, d2);
        TriangleDistances left = d2;
        for (;;) {  // the nearest in double, until single precision rules out all others
          const auto least = static_cast<std::uint32_t>(std::min_element(left.begin(), left.end()) - left.begin());
          if (!(left[least] <= limit)) break;
          left[least] = std::numeric_limits<float>::infinity();
          const FlatPoint p = closest_on_triangle(mesh, first + least, x);
          if (!(p.distance2 < flat.distance2) || p.distance2 > within * within) continue;
          flat = p;
          distance = std::sqrt(p.distance2);
          limit = distance2_limit(distance, round);
          band = distance2_limit(kBand * distance, round);
        }
        for (std::uint32_t l = 0; l < count; ++l)
          if (d2[l] <= band) near.add(first + l, d2[l], band);
      });
  if (!flat.valid()) return {};
  const SurfaceFoot closest = closest_point(mesh, flat.triangle, x);
  const double farthest = std::min(within, kSamePart * closest.distance());
  SurfaceFoot vertex;
  try_virtual(mesh, x, flat.triangle, farthest, vertex);
  for (std::uint32_t i = 0; i < near.count; ++i) {
    const float most = distance2_limit(vertex.valid() ? vertex.distance() : farthest, round);
    if (near.list[i].distance2 <= most) try_virtual(mesh, x, near.list[i].triangle, farthest, vertex);
  }
  if (near.complete && vertex.valid() && vertex.distance() <= kBand * distance) return prefer_virtual(vertex, closest);

  const auto bound = [&] { return vertex.valid() ? vertex.distance() : farthest; };
  visit_runs_near(mesh, x, bound, [&](std::uint32_t first, std::uint32_t count) {
    triangle_distances2(mesh, first, count, x, d2);
    for (std::uint32_t l = 0; l < count; ++l)
      if (d2[l] <= distance2_limit(bound(), round)) try_virtual(mesh, x, first + l, farthest, vertex);
  });
  return prefer_virtual(vertex, closest);
}

SurfaceFoot nearest_by_brute_force(const Mesh& mesh, dvec3 x, double within) {
  SurfaceFoot vertex, closest;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const SurfaceFoot a = virtual_vertex(mesh, t, x), b = closest_point(mesh, t, x);
    if (a.valid() && a.distance() <= within) keep_nearer(vertex, a);
    if (b.distance() <= within) keep_nearer(closest, b);
  }
  return prefer_virtual(vertex, closest);
}

Tracked track(const Mesh& mesh, const SurfaceFoot& last, dvec3 x) {
  constexpr int kMaxWalk = 64;
  Tracked result;
  std::uint32_t triangle = last.triangle;
  dvec3 b = last.barycentric;
  double height = last.height;
  bool at_border = false;
  for (int step = 0; step < kMaxWalk; ++step) {
    const Corner3 c = corners(mesh, triangle);
    if (!continue_virtual_vertex(c, x, b, height)) break;
    if (b.x >= kWalkInside && b.y >= kWalkInside && b.z >= kWalkInside) {
      result.point = surface_point(c, triangle, b, height);
      result.point.interpolated = true;
      return result;
    }
    const std::uint32_t next = mesh.across[triangle][edge_to_cross(b)];
    if (next == kBorder) {
      at_border = true;
      break;
    }
    triangle = next;
    b = dvec3(1.0 / 3);
  }

  // The walk stalled. Searches the triangles near the last foot; prefers the virtual vertex nearest to that foot, else
  // takes the closest point.
  const double around = 4 * length(x - (last.foot + last.height * last.normal)) + 2 * mesh.mean_edge;
  SurfaceFoot closest;
  double best_step = around;
  visit_near(
      mesh, last.foot, [&] { return around; },
      [&](std::uint32_t t) {
        const SurfaceFoot p = virtual_vertex(mesh, t, x);
        if (p.valid()) {
          const double moved = length(p.foot - last.foot);
          if (moved < best_step) {
            best_step = moved;
            result.point = p;
          }
        }
        keep_nearer(closest, closest_point(mesh, t, x));
      });
  if (result.point.valid()) return result;
  result.point = closest.valid() ? closest : last;
  if (at_border && closest.valid()) {
    // Past the rim if the closest point is on a border edge and x is beyond it, seen along the surface.
    const uvec3 across = mesh.across[closest.triangle];
    const Corner3 c = corners(mesh, closest.triangle);
    for (int edge = 0; edge < 3; ++edge) {
      if (across[edge] != kBorder || closest.barycentric[(edge + 2) % 3] > 1e-9) continue;
      const dvec3 outward = cross(c.p[(edge + 1) % 3] - c.p[edge], closest.normal);
      if (dot(x - closest.foot, outward) > 0) result.left_border = true;
    }
  }
  return result;
}

Entry first_entry(const Mesh& mesh, dvec3 from, dvec3 to) {
  Entry best;
  const dvec3 d = to - from;
  if (!(dot(d, d) > 0)) return best;
  visit_along(
      mesh, from, to, [&] { return best.fraction; },
      [&](std::uint32_t t) {
        const Corner3 c = corners(mesh, t);
        const dvec3 e1 = c.p[1] - c.p[0], e2 = c.p[2] - c.p[0], p = cross(d, e2);
        const double det = dot(e1, p);
        if (!(det > 0)) return;  // parallel, or leaving through the outer side
        const dvec3 s = from - c.p[0], q = cross(s, e1);
        const double u = dot(s, p) / det, v = dot(d, q) / det, fraction = dot(e2, q) / det;
        // A crossing on an edge belongs to both triangles, so that none is missed between them.
        constexpr double kEdge = 1e-7;
        if (u < -kEdge || v < -kEdge || u + v > 1 + kEdge || fraction < 0 || fraction > 1) return;
        if (fraction < best.fraction) best = {t, fraction, {1 - u - v, u, v}};
      });
  return best;
}

}  // namespace pliant
