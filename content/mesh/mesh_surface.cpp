#include "content/mesh/mesh_surface.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr std::size_t kGrain = 1 << 12;  // vertices

// A triangle's edge as seen from its lower vertex.
struct EdgeSide {
  std::uint32_t far;   // the higher vertex
  std::uint32_t edge;  // 3 * triangle + i, the side from corner i to corner i+1
  bool outgoing;       // runs from the lower to the higher vertex
};

std::uint32_t& across_of(Mesh& mesh, std::uint32_t edge) {
  return mesh.across[edge / 3][static_cast<int>(edge % 3)];
}

}  // namespace

Corners corners_of(const Mesh& mesh) {
  Corners c;
  c.first.assign(mesh.vertex_count + 2, 0);
  c.corner.resize(mesh.triangles.size() * 3);
  for (const uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) ++c.first[t[i] + 2];
  for (std::size_t v = 2; v < c.first.size(); ++v) c.first[v] += c.first[v - 1];
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) c.corner[c.first[mesh.triangles[t][i] + 1]++] = 3 * t + static_cast<std::uint32_t>(i);
  c.first.pop_back();
  return c;
}

void NormalSum::add(const Mesh& mesh, std::uint32_t corner) {
  const uvec3 t = mesh.triangles[corner / 3];
  const int i = static_cast<int>(corner % 3);
  const dvec3 p(mesh.position(t[i]));
  const dvec3 e = dvec3(mesh.position(t[(i + 1) % 3])) - p, f = dvec3(mesh.position(t[(i + 2) % 3])) - p;
  const dvec3 n = cross(e, f);
  const double twice_area = length(n), angle = std::atan2(twice_area, dot(e, f));
  // sin / (|e| |f|), which is exact on a sphere however it is triangulated (Max 1999, Weights for computing vertex
  // normals from facet normals). A needle's short side counts as at least a fourth of its long one.
  const double a = length(e), b = length(f), longest = std::max(a, b),
               shortest = std::max(std::min(a, b), 0.25 * longest);
  const double weight = std::sin(angle) / (longest * shortest);
  sum_ += n * (weight / twice_area);
  weights_ += weight;
  area_ += twice_area / 6.0;
  if (twice_area > largest_area_) {
    largest_area_ = twice_area;
    largest_ = n / twice_area;
  }
}

void measure_vertices(Mesh& mesh, const Corners& corners, MeshReport& report) {
  std::atomic<std::uint32_t> cancelled{0};
  parallel_for(mesh.vertex_count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      NormalSum sum;
      for (std::uint32_t c = corners.first[v]; c < corners.first[v + 1]; ++c) sum.add(mesh, corners.corner[c]);
      if (sum.cancels()) cancelled.fetch_add(1, std::memory_order_relaxed);
      const vec3 normal = sum.normal();
      mesh.nx[v] = normal.x;
      mesh.ny[v] = normal.y;
      mesh.nz[v] = normal.z;
      mesh.area[v] = static_cast<float>(sum.area());
    }
  });
  report.cancelled_normals = cancelled;
}

std::vector<SideAgainst> connect_triangles(Mesh& mesh, const Corners& corners, MeshReport& report) {
  mesh.across.assign(mesh.triangles.size(), uvec3(kBorder));
  std::atomic<std::uint32_t> border{0}, non_manifold{0};
  std::vector<SideAgainst> against;
  std::mutex against_mutex;
  parallel_for(mesh.vertex_count, kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<EdgeSide> sides;
    std::uint32_t borders = 0, non_manifolds = 0;
    for (std::size_t v = begin; v < end; ++v) {
      // The edges whose lower vertex is v: every edge of the mesh is visited from exactly one vertex.
      sides.clear();
      for (std::uint32_t c = corners.first[v]; c < corners.first[v + 1]; ++c) {
        const std::uint32_t t = corners.corner[c] / 3, i = corners.corner[c] % 3, before = (i + 2) % 3;
        const uvec3 vertex = mesh.triangles[t];
        const std::uint32_t next = vertex[static_cast<int>((i + 1) % 3)], last = vertex[static_cast<int>(before)];
        if (next > v) sides.push_back({next, 3 * t + i, true});
        if (last > v) sides.push_back({last, 3 * t + before, false});
      }
      std::sort(sides.begin(), sides.end(),
                [](const EdgeSide& a, const EdgeSide& b) { return a.far != b.far ? a.far < b.far : a.edge < b.edge; });

      for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i + 1;
        while (j < sides.size() && sides[j].far == sides[i].far) ++j;
        if (j - i == 2 && sides[i].outgoing != sides[i + 1].outgoing) {
          across_of(mesh, sides[i].edge) = sides[i + 1].edge / 3;
          across_of(mesh, sides[i + 1].edge) = sides[i].edge / 3;
        } else {
          ++(j - i == 1 ? borders : non_manifolds);
          if (j - i == 2) {
            const std::scoped_lock lock(against_mutex);  // rare
            against.push_back({sides[i].edge, sides[i + 1].edge});
            against.push_back({sides[i + 1].edge, sides[i].edge});
          }
        }
        i = j;
      }
    }
    border.fetch_add(borders, std::memory_order_relaxed);
    non_manifold.fetch_add(non_manifolds, std::memory_order_relaxed);
  });
  report.border_edges = border;
  report.non_manifold_edges = non_manifold;
  mesh.closed = border == 0 && non_manifold == 0;
  std::sort(against.begin(), against.end());
  return against;
}

}  // namespace pliant
