#include "content/tets/surface_samples.h"

#include <algorithm>
#include <cmath>

#include "content/tets/tet_embed.h"

namespace pliant {
namespace {

constexpr int kMostPieces = 64;  // of an edge

double longest_side(const std::vector<dvec3>& nodes, const Tet& tet) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < i; ++k) longest = std::max(longest, length(nodes[tet[i]] - nodes[tet[k]]));
  return longest;
}

}  // namespace

std::vector<SurfaceSample> sample_surface(const Mesh& surface, double spacing, const TetMesh& tets) {
  std::vector<SurfaceSample> out;
  std::vector<dvec3> points, normals;
  for (const uvec3 t : surface.triangles) {
    const dvec3 a(surface.position(t.x)), e = dvec3(surface.position(t.y)) - a, f = dvec3(surface.position(t.z)) - a;
    const dvec3 n = cross(e, f);
    const double twice = length(n), longest = std::max({length(e), length(f), length(f - e)});
    if (!(twice > 0.0)) continue;
    const int parts = std::clamp(static_cast<int>(std::ceil(longest / spacing - 1e-9)), 1, kMostPieces);
    const auto add = [&](double x, double y) {
      out.push_back({a + (x / parts) * e + (y / parts) * f, n / twice, 0.5 * twice / (parts * parts), {}});
    };
    for (int i = 0; i < parts; ++i)
      for (int k = 0; i + k < parts; ++k) {
        add(i + 1.0 / 3, k + 1.0 / 3);
        if (i + k + 1 < parts) add(i + 2.0 / 3, k + 2.0 / 3);
      }
  }
  for (const SurfaceSample& s : out) points.push_back(s.position), normals.push_back(s.normal);
  const std::vector<Embedding> places = embed(points, normals, tets.nodes, tets.tets);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].embedding = places[i];
  return out;
}

std::vector<SurfaceSample> sample_surface(const Mesh& surface, const TetMesh& tets) {
  double cell = tets.report.cell;
  if (!(cell > 0.0)) {
    for (const Tet& tet : tets.tets) cell += longest_side(tets.nodes, tet);
    cell /= static_cast<double>(tets.tets.size());
  }
  return sample_surface(surface, kSampleOfCell * cell, tets);
}

}  // namespace pliant
