#include "engine/session/source_place.h"

#include <algorithm>
#include <limits>

namespace pliant {

dvec3 nearest_weights(dvec3 a, dvec3 b, dvec3 c, dvec3 x) {
  const dvec3 normal = cross(b - a, c - a);
  const double area = dot(normal, normal);
  if (area > 0.0) {
    const double u = dot(cross(b - x, c - x), normal) / area, v = dot(cross(c - x, a - x), normal) / area;
    if (u >= 0.0 && v >= 0.0 && u + v <= 1.0) return {u, v, 1.0 - u - v};
  }
  // Otherwise the point is on an edge.
  const dvec3 corner[3] = {a, b, c};
  dvec3 best{1, 0, 0};
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < 3; ++i) {
    const dvec3 from = corner[i], way = corner[(i + 1) % 3] - from;
    const double length2 = dot(way, way);
    const double t = length2 > 0.0 ? std::clamp(dot(x - from, way) / length2, 0.0, 1.0) : 0.0;
    const dvec3 off = from + t * way - x;
    if (dot(off, off) >= least) continue;
    least = dot(off, off);
    best = dvec3(0);
    best[i] = 1.0 - t;
    best[(i + 1) % 3] = t;
  }
  return best;
}

SourcePlace nearest_source(const std::vector<dvec3>& source, const std::vector<uvec3>& triangles, dvec3 x) {
  SourcePlace best;
  double least = std::numeric_limits<double>::max();
  for (const uvec3& t : triangles) {
    const dvec3 w = nearest_weights(source[t.x], source[t.y], source[t.z], x);
    const dvec3 off = w.x * source[t.x] + w.y * source[t.y] + w.z * source[t.z] - x;
    if (dot(off, off) >= least) continue;
    least = dot(off, off);
    best = {t, w};
  }
  return best;
}

std::vector<uvec3> source_triangles(const LevelMesh& mesh) {
  std::vector<uvec3> triangles;
  std::uint32_t first = 0;
  for (const Primitive& p : mesh.primitives) {
    for (std::size_t i = 0; i + 2 < p.index.size(); i += 3)
      triangles.emplace_back(first + p.index[i], first + p.index[i + 1], first + p.index[i + 2]);
    first += static_cast<std::uint32_t>(p.position.size());
  }
  return triangles;
}

}  // namespace pliant
