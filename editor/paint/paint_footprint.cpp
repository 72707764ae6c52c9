// Geodesic queries of a PaintSurface. Fast marching as in systems/touch/collide/surface_distance.cpp: Kimmel & Sethian
// 1998 with the source unfolded into each triangle's plane. A node reached by a shorter way later is expanded again, so
// that obtuse triangles cause no error.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "editor/paint/paint_surface.h"
#include "systems/touch/collide/triangle_tree.h"
#include "systems/touch/collide/unfold.h"

namespace pliant {
namespace {

constexpr float kUnreached = std::numeric_limits<float>::infinity();
// Shorter by more than rounding; otherwise two nodes could improve each other forever.
constexpr float kShorter = 1 - 1e-5f;

std::vector<std::uint32_t> ascending(std::vector<std::uint32_t> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

// The first `count` places that have a flag; ascending.
std::vector<std::uint32_t> flagged(const std::vector<std::uint8_t>& flags, std::uint32_t count) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < count; ++i)
    if (flags[i]) found.push_back(i);
  return found;
}

}  // namespace

// Writes the distances of all nodes within the radius, and of some beyond, to `work`.
void PaintSurface::march(const SurfaceHit& hit, double radius, const PaintMask& mask, MarchWork& work) const {
  const Topology& topology = topology_of(mask);
  const auto position = [&](std::uint32_t node) {
    return mesh_.position(topology.vertex.empty() ? node : topology.vertex[node]);
  };
  const auto later = [](const MarchWork::Item& a, const MarchWork::Item& b) {
    return a.distance != b.distance ? a.distance > b.distance : a.node > b.node;
  };
  std::vector<float>& distance = work.distance_;
  for (const std::uint32_t node : work.touched_) distance[node] = kUnreached;
  work.touched_.clear();
  work.heap_.clear();
  const std::size_t nodes = topology.corners.first.size() - 1;
  if (distance.size() < nodes) distance.resize(nodes, kUnreached);

  const auto reached = [&](std::uint32_t node, float r) {
    if (!(r < kShorter * distance[node])) return;
    if (distance[node] == kUnreached) work.touched_.push_back(node);
    distance[node] = r;
    work.heap_.push_back({r, node});
    std::push_heap(work.heap_.begin(), work.heap_.end(), later);
  };
  const uvec3 start = nodes_of(topology, hit.triangle);
  for (int i = 0; i < 3; ++i) reached(start[i], length(position(start[i]) - vec3(hit.point)));

  // Corners of a triangle at the rim may lie beyond it, and their distances are needed.
  const auto rim = static_cast<float>(radius);
  float longest = 0.0f;
  while (!work.heap_.empty()) {
    std::pop_heap(work.heap_.begin(), work.heap_.end(), later);
    const auto [r, u] = work.heap_.back();
    work.heap_.pop_back();
    if (kShorter * r > distance[u]) continue;  // a shorter way was found meanwhile
    if (r > rim + std::min(longest, rim)) break;
    const vec3 pu = position(u);
    for (std::uint32_t c = topology.corners.first[u]; c < topology.corners.first[u + 1]; ++c) {
      const std::uint32_t triangle = topology.corners.corner[c] / 3;
      const auto i = static_cast<int>(topology.corners.corner[c] % 3);
      if (mask.primitive && source_triangle_[triangle].primitive != hit.source.primitive) continue;
      const uvec3& t = nodes_of(topology, triangle);
      const std::uint32_t pair[2] = {t[(i + 1) % 3], t[(i + 2) % 3]};
      const vec3 p[2] = {position(pair[0]), position(pair[1])};
      for (int k = 0; k < 2; ++k) {
        const float edge = length(p[k] - pu);
        if (r <= rim) longest = std::max(longest, edge);
        const float other = distance[pair[1 - k]];
        reached(pair[k], other < kUnreached ? arrive(pu, p[1 - k], p[k], r, other).distance : r + edge);
      }
    }
  }
}

std::vector<ReachedVertex> PaintSurface::footprint(const SurfaceHit& hit, double radius, const PaintMask& mask,
                                                   MarchWork& work) const {
  std::vector<ReachedVertex> found;
  if (!hit.valid() || !(radius > 0.0)) return found;
  march(hit, radius, mask, work);
  const Topology& topology = topology_of(mask);
  for (const std::uint32_t node : work.touched_)
    if (work.distance_[node] <= static_cast<float>(radius))
      found.push_back({topology.vertex.empty() ? node : topology.vertex[node], node, work.distance_[node]});
  if (topology.vertex.empty()) return found;

  // A vertex reached on several sides of a crease takes its smallest distance.
  std::sort(found.begin(), found.end(), [](const ReachedVertex& a, const ReachedVertex& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.distance < b.distance;
  });
  found.erase(std::unique(found.begin(), found.end(),
                          [](const ReachedVertex& a, const ReachedVertex& b) { return a.vertex == b.vertex; }),
              found.end());
  std::sort(found.begin(), found.end(), [](const ReachedVertex& a, const ReachedVertex& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.vertex < b.vertex;
  });
  return found;
}

std::vector<std::uint32_t> PaintSurface::triangles_under(const SurfaceHit& hit, double radius, MarchWork& work) const {
  if (!hit.valid() || !(radius > 0.0)) return {};
  march(hit, radius, {}, work);
  std::vector<std::uint32_t> found{hit.triangle};
  // Every triangle reached by the march has a corner among the touched nodes, including triangles much larger than the
  // brush.
  for (const std::uint32_t node : work.touched_)
    for (std::uint32_t c = whole_.corners.first[node]; c < whole_.corners.first[node + 1]; ++c) {
      const std::uint32_t t = whole_.corners.corner[c] / 3;
      if (closest_on_triangle(mesh_, t, hit.point).distance2 <= radius * radius) found.push_back(t);
    }
  return ascending(std::move(found));
}

std::vector<std::uint32_t> PaintSurface::connected(const SurfaceHit& hit, const PaintMask& mask) const {
  if (!hit.valid()) return {};
  const Topology& topology = topology_of(mask);
  std::vector<std::uint8_t> met(topology.corners.first.size() - 1, 0);
  std::vector<std::uint32_t> nodes;
  const auto meet = [&](const uvec3& t) {
    for (int i = 0; i < 3; ++i)
      if (!met[t[i]]) met[t[i]] = 1, nodes.push_back(t[i]);
  };
  meet(nodes_of(topology, hit.triangle));
  for (std::size_t next = 0; next < nodes.size(); ++next) {
    const std::uint32_t node = nodes[next];
    for (std::uint32_t c = topology.corners.first[node]; c < topology.corners.first[node + 1]; ++c) {
      const std::uint32_t t = topology.corners.corner[c] / 3;
      if (!mask.primitive || source_triangle_[t].primitive == hit.source.primitive) meet(nodes_of(topology, t));
    }
  }
  if (!topology.vertex.empty())
    for (const std::uint32_t node : nodes) met[topology.vertex[node]] = 1;
  return flagged(met, mesh_.vertex_count);
}

std::vector<std::uint32_t> PaintSurface::of_primitive(std::uint32_t primitive) const {
  std::vector<std::uint8_t> met(mesh_.vertex_count, 0);
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
    if (source_triangle_[t].primitive == primitive)
      for (int i = 0; i < 3; ++i) met[mesh_.triangles[t][i]] = 1;
  return flagged(met, mesh_.vertex_count);
}

std::vector<std::uint32_t> PaintSurface::in_box(const Box& box) const {
  std::vector<std::uint32_t> found;
  float least = kUnreached;
  for (std::uint32_t v = 0; v < mesh_.vertex_count; ++v) {
    const vec3 p = mesh_.position(v), away = glm::max(glm::max(box.min - p, p - box.max), vec3(0));
    const float distance2 = dot(away, away);
    if (distance2 < least || (distance2 == 0.0f && !found.empty())) {
      if (least > 0.0f) found.clear();
      least = distance2;
      found.push_back(v);
    }
  }
  return found;
}

}  // namespace pliant
