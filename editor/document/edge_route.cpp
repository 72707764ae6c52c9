#include "editor/document/edge_route.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace pliant {

std::vector<dvec3> over_edges(const PaintSurface& surface, const SurfaceHit& from, const SurfaceHit& to) {
  const Mesh& mesh = surface.mesh();
  std::vector<dvec3> out{from.point};
  if (from.triangle != to.triangle) {
    struct Open {
      double whole, gone;
      std::uint32_t vertex;
      bool operator<(const Open& other) const { return whole > other.whole; }
    };
    std::vector<double> gone(mesh.vertex_count, std::numeric_limits<double>::infinity());
    std::vector<std::uint32_t> before(mesh.vertex_count, SurfaceHit::kNone);
    std::priority_queue<Open> open;
    const auto reach = [&](std::uint32_t v, std::uint32_t by, double way) {
      if (way >= gone[v]) return;
      gone[v] = way;
      before[v] = by;
      open.push({way + length(dvec3(mesh.position(v)) - to.point), way, v});
    };
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t v = mesh.triangles[from.triangle][i];
      reach(v, SurfaceHit::kNone, length(dvec3(mesh.position(v)) - from.point));
    }
    const uvec3 goal = mesh.triangles[to.triangle];
    std::uint32_t end = SurfaceHit::kNone;
    while (!open.empty()) {
      const Open now = open.top();
      open.pop();
      if (now.gone > gone[now.vertex]) continue;
      if (now.vertex == goal.x || now.vertex == goal.y || now.vertex == goal.z) {
        end = now.vertex;
        break;
      }
      surface.neighbours(now.vertex, {}, [&](std::uint32_t next) {
        reach(next, now.vertex, now.gone + length(dvec3(mesh.position(next)) - dvec3(mesh.position(now.vertex))));
      });
    }
    std::vector<dvec3> back;
    for (std::uint32_t v = end; v != SurfaceHit::kNone; v = before[v]) back.push_back(dvec3(mesh.position(v)));
    out.insert(out.end(), back.rbegin(), back.rend());
  }
  out.push_back(to.point);
  return out;
}

std::vector<dvec3> resampled(const std::vector<dvec3>& line, int steps) {
  std::vector<double> way{0.0};
  for (std::size_t i = 1; i < line.size(); ++i) way.push_back(way.back() + length(line[i] - line[i - 1]));
  std::vector<dvec3> out;
  std::size_t k = 0;
  for (int i = 0; i <= steps; ++i) {
    const double w = way.back() * i / steps;
    while (k + 2 < way.size() && way[k + 1] < w) ++k;
    const double piece = way[k + 1] - way[k];
    out.push_back(line[k] + (piece > 0.0 ? std::clamp((w - way[k]) / piece, 0.0, 1.0) : 0.0) * (line[k + 1] - line[k]));
  }
  return out;
}

}  // namespace pliant
