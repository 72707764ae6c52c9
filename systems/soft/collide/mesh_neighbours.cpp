#include "systems/soft/collide/mesh_neighbours.h"

#include <algorithm>
#include <queue>
#include <utility>

namespace pliant {

MeshNeighbours::MeshNeighbours(const Mesh& mesh, double distance, const std::vector<std::uint32_t>& first,
                               const std::vector<std::uint32_t>& triangles) {
  find_near(mesh, distance, first, triangles);
  find_settled(mesh, first, triangles);
}

// Dijkstra along edges from every vertex, at rest.
void MeshNeighbours::find_near(const Mesh& mesh, double distance, const std::vector<std::uint32_t>& first,
                               const std::vector<std::uint32_t>& triangles) {
  std::vector<double> best(mesh.vertex_count, 1e300);
  std::vector<std::uint32_t> reached;
  using Item = std::pair<double, std::uint32_t>;
  near_first_.assign(1, 0);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
    const auto offer = [&](std::uint32_t w, double d) {
      if (d > distance && w != v) return;
      if (d >= best[w]) return;
      if (best[w] == 1e300) reached.push_back(w);
      best[w] = d;
      open.push({d, w});
    };
    offer(v, 0.0);
    while (!open.empty()) {
      const auto [d, w] = open.top();
      open.pop();
      if (d > best[w]) continue;
      for (std::uint32_t k = first[w]; k < first[w + 1]; ++k)
        for (int i = 0; i < 3; ++i) {
          const std::uint32_t x = mesh.triangles[triangles[k]][i];
          // Vertices that share a triangle are neighbours, regardless of their distance.
          const double step = static_cast<double>(length(mesh.position(x) - mesh.position(w)));
          offer(x, w == v ? std::min(step, distance) : d + step);
        }
    }
    std::sort(reached.begin(), reached.end());
    for (const std::uint32_t w : reached) best[w] = 1e300;
    near_.insert(near_.end(), reached.begin(), reached.end());
    near_first_.push_back(static_cast<std::uint32_t>(near_.size()));
    reached.clear();
  }
}

void MeshNeighbours::find_settled(const Mesh& mesh, const std::vector<std::uint32_t>& first,
                                  const std::vector<std::uint32_t>& triangles) {
  static_assert(kLeafSize * kLeafSize <= 16);
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<std::uint8_t> near_to(mesh.vertex_count, 0);  // bit i: corner i of the current triangle
  std::vector<std::uint32_t> looked_at(count, count);       // last triangle that visited it
  std::vector<Leaves> found;
  leaves_first_.assign(1, 0);
  for (std::uint32_t leaf = 0; leaf * kLeafSize < count; ++leaf) {
    found.clear();
    for (std::uint32_t s = leaf * kLeafSize; s < std::min((leaf + 1) * kLeafSize, count); ++s) {
      const uvec3 corner = mesh.triangles[s];
      const auto for_each_near = [&](auto use) {
        for (int i = 0; i < 3; ++i)
          for (std::uint32_t k = near_first_[corner[i]]; k < near_first_[corner[i] + 1]; ++k) use(i, near_[k]);
      };
      for_each_near([&](int i, std::uint32_t v) { near_to[v] |= static_cast<std::uint8_t>(1 << i); });
      for_each_near([&](int, std::uint32_t v) {
        for (std::uint32_t k = first[v]; k < first[v + 1]; ++k) {
          const std::uint32_t t = triangles[k];
          if (t / kLeafSize < leaf || looked_at[t] == s) continue;
          looked_at[t] = s;
          const uvec3 c = mesh.triangles[t];
          const unsigned x = near_to[c.x], y = near_to[c.y], z = near_to[c.z];
          // Vertices: each is near to a corner of the other triangle. Edges: two corners of s are near to every edge of
          // t, so that every edge of s is covered.
          const auto two = [](unsigned bits) { return (bits & (bits - 1u)) != 0u; };
          if (x == 0 || y == 0 || z == 0 || (x | y | z) != 7u) continue;
          if (!two(x | y) || !two(y | z) || !two(z | x)) continue;
          found.push_back(
              {t / kLeafSize, static_cast<std::uint16_t>(1u << (kLeafSize * (s % kLeafSize) + t % kLeafSize))});
        }
      });
      for_each_near([&](int, std::uint32_t v) { near_to[v] = 0; });
    }
    std::sort(found.begin(), found.end(), [](const Leaves& a, const Leaves& b) { return a.other < b.other; });
    for (const Leaves& f : found) {
      if (leaves_.size() == leaves_first_.back() || leaves_.back().other != f.other) leaves_.push_back({f.other, 0});
      leaves_.back().settled = static_cast<std::uint16_t>(leaves_.back().settled | f.settled);
    }
    leaves_first_.push_back(static_cast<std::uint32_t>(leaves_.size()));
  }
}

bool MeshNeighbours::near(std::uint32_t a, std::uint32_t b) const {
  return std::binary_search(near_.begin() + near_first_[a], near_.begin() + near_first_[a + 1], b);
}

std::uint16_t MeshNeighbours::settled(std::uint32_t a, std::uint32_t b) const {
  const auto begin = leaves_.begin() + leaves_first_[a], end = leaves_.begin() + leaves_first_[a + 1];
  const auto at = std::lower_bound(begin, end, b, [](const Leaves& l, std::uint32_t other) { return l.other < other; });
  return at != end && at->other == b ? at->settled : std::uint16_t{0};
}

}  // namespace pliant
