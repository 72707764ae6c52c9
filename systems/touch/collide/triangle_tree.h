// Queries on the tree of a mesh at rest (components/mesh.h, TriangleTree::nodes): the closest point of its flat
// triangles, everything near a point, everything along a segment. Object frame; results in double, boxes in single.
//
// A node's eight boxes are tested at once, in loops that the compiler vectorises. Boxes also contain the triangles'
// curved patches, so a visitor that needs the distance to a patch may prune by them as well.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "components/math.h"
#include "components/mesh.h"

namespace pliant {

struct FlatPoint {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t triangle = kNone;
  dvec3 barycentric{1, 0, 0};                                  // [1] of the three corners
  double distance2 = std::numeric_limits<double>::infinity();  // [m2]

  bool valid() const { return triangle != kNone; }
};

// The closest point of the flat triangles within `within` [m]; invalid if there is none. A `hint`, the triangle of a
// nearby query, is tested first and prunes most of the tree; it never changes the distance found.
FlatPoint closest_flat(const Mesh& mesh, dvec3 x, double within, std::uint32_t hint = FlatPoint::kNone);

// The closest point of one flat triangle.
FlatPoint closest_on_triangle(const Mesh& mesh, std::uint32_t triangle, dvec3 x);

// Squared distances in single precision to the flat triangles [first, first + count), count <= kTreeNodeWidth, eight at
// once; the places after them get infinity. They differ from closest_on_triangle's by less than rounding() does. [m2]
using TriangleDistances = std::array<float, kTreeNodeWidth>;
void triangle_distances2(const Mesh& mesh, std::uint32_t first, std::uint32_t count, dvec3 x, TriangleDistances& out);

// Bound of the single-precision error of a distance between x and the mesh; pruning allows for it. [m]
inline double rounding(const Mesh& mesh, const dvec3& x) {
  const dvec3 reach = glm::max(dvec3(glm::max(glm::abs(mesh.box.min), glm::abs(mesh.box.max))), glm::abs(x));
  return 1e-6 * std::max({reach.x, reach.y, reach.z});
}

// Upper bound for comparison with squared distances in single precision; never too small.
inline float distance2_limit(double distance, double round) {
  const double d = distance + round;
  return static_cast<float>(std::min(1.000001 * d * d, 1e37));  // below the infinity of empty boxes
}

namespace tree {

// Depth at most 27 (content/mesh/tree.cpp), with up to seven siblings stacked per level.
inline constexpr std::uint32_t kStack = 256;

struct Entry {
  float key;  // lower bound of the contents: squared distance, or fraction of a segment
  std::uint32_t first, count;
};

inline void box_distances2(const TreeNode& node, vec3 x, float (&out)[kTreeNodeWidth]) {
  for (std::uint32_t i = 0; i < kTreeNodeWidth; ++i) {
    const float ax = node.low[0][i] - x.x, bx = x.x - node.high[0][i], cx = ax > bx ? ax : bx, dx = cx > 0 ? cx : 0;
    const float ay = node.low[1][i] - x.y, by = x.y - node.high[1][i], cy = ay > by ? ay : by, dy = cy > 0 ? cy : 0;
    const float az = node.low[2][i] - x.z, bz = x.z - node.high[2][i], cz = az > bz ? az : bz, dz = cz > 0 ? cz : 0;
    out[i] = dx * dx + dy * dy + dz * dz;
  }
}

// Fractions at which a segment enters the boxes; 2 if it does not before `last`.
struct Segment {
  vec3 from, inverse;  // 1 / (to - from); huge for an axis without motion, which then decides by itself
  float round;
};
inline void box_entries(const TreeNode& node, const Segment& s, float last, float (&out)[kTreeNodeWidth]) {
  for (std::uint32_t i = 0; i < kTreeNodeWidth; ++i) {
    float enter = 0.0f, leave = last;
    for (int k = 0; k < 3; ++k) {
      const float a = (node.low[k][i] - s.round - s.from[k]) * s.inverse[k];
      const float b = (node.high[k][i] + s.round - s.from[k]) * s.inverse[k];
      const float low = a < b ? a : b, high = a < b ? b : a;
      enter = enter > low ? enter : low;
      leave = leave < high ? leave : high;
    }
    out[i] = enter * 0.999999f <= leave * 1.000001f ? enter : 2.0f;
  }
}

// Calls visit(first, count) with runs of triangles, smallest key first. keys(node, out) computes the keys of a node's
// places. limit() is evaluated before every box, because visits reduce it.
template <class Keys, class Limit, class Visit>
void descend(const Mesh& mesh, Keys keys, Limit limit, Visit visit) {
  const TreeNode* const nodes = mesh.tree.nodes.data();
  if (mesh.tree.nodes.empty()) return;
  std::array<Entry, kStack> stack;
  std::uint32_t top = 0;
  stack[top++] = {0.0f, 0, 0};
  while (top > 0) {
    const Entry at = stack[--top];
    const float most = limit();
    if (!(at.key <= most)) continue;
    if (at.count > 0) {
      visit(at.first, at.count);
      continue;
    }
    const TreeNode& node = nodes[at.first];
    alignas(32) float key[kTreeNodeWidth];
    keys(node, key);
    const std::uint32_t bottom = top;
    for (std::uint32_t i = 0; i < node.used; ++i) {
      if (!(key[i] <= most)) continue;
      std::uint32_t place = top++;
      for (; place > bottom && stack[place - 1].key < key[i]; --place) stack[place] = stack[place - 1];
      stack[place] = {key[i], node.first[i], node.count[i]};
      // Prefetches farther entries while nearer ones are visited.
      const char* const next = node.count[i] > 0 ? reinterpret_cast<const char*>(&mesh.triangles[node.first[i]])
                                                 : reinterpret_cast<const char*>(&nodes[node.first[i]]);
      __builtin_prefetch(next);
      __builtin_prefetch(next + 64);
      if (node.count[i] == 0) {
        __builtin_prefetch(next + 128);
        __builtin_prefetch(next + 192);
      }
    }
  }
}

}  // namespace tree

// Calls visit(first, count) with runs of triangles whose boxes are nearer to x than bound() [m], nearest boxes first.
template <class Bound, class Visit>
void visit_runs_near(const Mesh& mesh, dvec3 x, Bound bound, Visit visit) {
  const vec3 single(x);
  const double round = rounding(mesh, x);
  tree::descend(
      mesh, [&](const TreeNode& node, float(&key)[kTreeNodeWidth]) { tree::box_distances2(node, single, key); },
      [&] { return distance2_limit(bound(), round); }, visit);
}

// The same, triangle by triangle.
template <class Bound, class Visit>
void visit_near(const Mesh& mesh, dvec3 x, Bound bound, Visit visit) {
  visit_runs_near(mesh, x, bound, [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t t = first; t < first + count; ++t) visit(t);
  });
}

// Calls visit(triangle) where the segment enters the box of its run before the fraction bound() [1], earliest first.
template <class Bound, class Visit>
void visit_along(const Mesh& mesh, dvec3 from, dvec3 to, Bound bound, Visit visit) {
  tree::Segment segment{vec3(from), vec3(0), static_cast<float>(std::max(rounding(mesh, from), rounding(mesh, to)))};
  for (int k = 0; k < 3; ++k) {
    const double d = to[k] - from[k];
    segment.inverse[k] = static_cast<float>(std::abs(d) > 1e-30 ? 1 / d : std::copysign(1e30, d));
  }
  const auto last = [&] { return static_cast<float>(std::min(1.000001 * bound(), 1.000001)); };
  tree::descend(
      mesh, [&](const TreeNode& node, float(&key)[kTreeNodeWidth]) { tree::box_entries(node, segment, last(), key); },
      last,
      [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t t = first; t < first + count; ++t) visit(t);
      });
}

}  // namespace pliant
