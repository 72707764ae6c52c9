#include "systems/touch/surface_query.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pliant {
namespace {

double distance2(const Box& box, const vec3& x) {
  const vec3 d = glm::max(glm::max(box.min - x, x - box.max), vec3(0));
  return double(d.x) * d.x + double(d.y) * d.y + double(d.z) * d.z;
}

std::uint32_t run_end(std::uint32_t begin, std::uint32_t width, std::size_t count) {
  return static_cast<std::uint32_t>(std::min<std::size_t>(begin + width, count));
}

struct Node {
  std::uint32_t level, index;
  double key;  // lower bound of what is inside
};

// Boxes are single precision; queries round. A box is only left out when it is farther by more than that rounding.
double slack(const Mesh& mesh, const vec3& x) {
  const vec3 reach = glm::max(glm::abs(mesh.box.min), glm::max(glm::abs(mesh.box.max), glm::abs(x)));
  return 4e-7 * std::max({reach.x, reach.y, reach.z});
}

// Visits leaf triangles whose boxes are nearer than bound(), nearest children first. A fixed stack: levels * width.
template <class Bound, class Visit>
void visit_near(const Mesh& mesh, dvec3 x, Bound bound, Visit visit) {
  const auto& levels = mesh.tree.levels;
  if (levels.empty()) return;
  const vec3 xf(x);
  const double round = slack(mesh, xf);
  std::array<Node, 128> stack;
  std::uint32_t top = 0;
  stack[top++] = {static_cast<std::uint32_t>(levels.size() - 1), 0, 0.0};
  while (top > 0) {
    const Node node = stack[--top];
    if (node.key > bound() + round) continue;
    if (node.level == 0) {
      const std::uint32_t begin = node.index * kLeafSize, end = run_end(begin, kLeafSize, mesh.triangles.size());
      for (std::uint32_t t = begin; t < end; ++t) visit(t);
      continue;
    }
    const auto& children = levels[node.level - 1];
    const std::uint32_t begin = node.index * kTreeWidth, end = run_end(begin, kTreeWidth, children.size());
    std::array<Node, kTreeWidth> found;
    std::uint32_t count = 0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const double key = std::sqrt(distance2(children[i], xf));
      if (key > bound() + round) continue;
      std::uint32_t place = count++;
      for (; place > 0 && found[place - 1].key < key; --place) found[place] = found[place - 1];
      found[place] = {node.level - 1, i, key};
    }
    for (std::uint32_t i = 0; i < count; ++i)
      stack[top++] = found[i];  // farthest first, so the nearest is popped first
  }
}

void keep_nearer(SurfaceFoot& best, const SurfaceFoot& candidate) {
  if (candidate.valid() && (!best.valid() || candidate.distance() < best.distance())) best = candidate;
}

// Which edge's far side has a negative barycentric most; edges run from corner i to i+1, opposite corner (i+2)%3.
int edge_to_cross(dvec3 b) {
  const int corner = b.x < b.y ? (b.x < b.z ? 0 : 2) : (b.y < b.z ? 1 : 2);
  return (corner + 1) % 3;
}

// How far inside the triangle barycentrics must be for the walk to stop; edges belong to both sides.
constexpr double kWalkInside = -1e-9;

}  // namespace

// A virtual vertex more than this many times as far as the closest point belongs to another part of the surface.
constexpr double kSamePart = 2.0;

SurfaceFoot prefer_virtual(const SurfaceFoot& vertex, const SurfaceFoot& closest) {
  return vertex.valid() && vertex.distance() <= kSamePart * closest.distance() ? vertex : closest;
}

SurfaceFoot nearest(const Mesh& mesh, dvec3 x, double within) {
  SurfaceFoot vertex, closest;
  visit_near(
      mesh, x, [&] { return closest.valid() ? closest.distance() : within; },
      [&](std::uint32_t t) {
        const SurfaceFoot p = closest_point(mesh, t, x);
        if (p.distance() <= within) keep_nearer(closest, p);
      });
  if (!closest.valid()) return closest;
  // A height is a distance to a point of the triangle, so box distance is a lower bound for it too.
  const double farthest = std::min(within, kSamePart * closest.distance());
  visit_near(
      mesh, x, [&] { return vertex.valid() ? vertex.distance() : farthest; },
      [&](std::uint32_t t) {
        const SurfaceFoot p = virtual_vertex(mesh, t, x);
        if (p.valid() && p.distance() <= within) keep_nearer(vertex, p);
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

  // The walk stalled. Look at every triangle near the last foot; prefer the virtual vertex that continues it best, else
  // take the closest point.
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
    // Past the rim when the closest point is on a border edge and x lies beyond it, seen along the surface.
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
  const auto& levels = mesh.tree.levels;
  const dvec3 d = to - from;
  if (levels.empty() || !(dot(d, d) > 0)) return best;
  const double round = slack(mesh, glm::max(glm::abs(vec3(from)), glm::abs(vec3(to))));
  const auto enters = [&](const Box& box) {  // first fraction inside the box, or 2
    double t0 = 0.0, t1 = std::min(best.fraction, 1.0);
    for (int i = 0; i < 3; ++i) {
      const double low = box.min[i] - round, high = box.max[i] + round;
      if (d[i] == 0.0) {
        if (from[i] < low || from[i] > high) return 2.0;
        continue;
      }
      double a = (low - from[i]) / d[i], b = (high - from[i]) / d[i];
      if (a > b) std::swap(a, b);
      t0 = std::max(t0, a);
      t1 = std::min(t1, b);
    }
    return t0 <= t1 ? t0 : 2.0;
  };
  std::array<Node, 128> stack;
  std::uint32_t top = 0;
  stack[top++] = {static_cast<std::uint32_t>(levels.size() - 1), 0, 0.0};
  while (top > 0) {
    const Node node = stack[--top];
    if (node.key > best.fraction) continue;
    if (node.level > 0) {
      const auto& children = levels[node.level - 1];
      const std::uint32_t begin = node.index * kTreeWidth, end = run_end(begin, kTreeWidth, children.size());
      for (std::uint32_t i = begin; i < end; ++i)
        if (const double key = enters(children[i]); key <= 1.0) stack[top++] = {node.level - 1, i, key};
      continue;
    }
    const std::uint32_t begin = node.index * kLeafSize, end = run_end(begin, kLeafSize, mesh.triangles.size());
    for (std::uint32_t t = begin; t < end; ++t) {
      const Corner3 c = corners(mesh, t);
      const dvec3 e1 = c.p[1] - c.p[0], e2 = c.p[2] - c.p[0], p = cross(d, e2);
      const double det = dot(e1, p);
      if (!(det > 0)) continue;  // parallel, or leaving through the outer side
      const dvec3 s = from - c.p[0], q = cross(s, e1);
      const double u = dot(s, p) / det, v = dot(d, q) / det, fraction = dot(e2, q) / det;
      // A crossing on an edge belongs to both triangles, so none can be missed between them.
      constexpr double kEdge = 1e-7;
      if (u < -kEdge || v < -kEdge || u + v > 1 + kEdge || fraction < 0 || fraction > 1) continue;
      if (fraction < best.fraction) best = {t, fraction, {1 - u - v, u, v}};
    }
  }
  return best;
}

}  // namespace pliant
