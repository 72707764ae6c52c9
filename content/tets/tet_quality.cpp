#include "content/tets/tet_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace pliant {
namespace {

struct TetShape {
  double smallest = 0.0, largest = 0.0;  // [rad] dihedral
  double ratio = 0.0;                    // [1] 3 r/R
};

// Faces are numbered by the opposite corner; `normal` points inward and its length is twice the area.
TetShape shape_of(const dvec3 (&p)[4]) {
  constexpr int kFace[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  dvec3 normal[4];
  double areas = 0.0;
  for (int f = 0; f < 4; ++f) {
    const dvec3 a = p[kFace[f][0]];
    normal[f] = cross(p[kFace[f][1]] - a, p[kFace[f][2]] - a);
    areas += 0.5 * length(normal[f]);
  }
  TetShape shape{std::numbers::pi, 0.0, 0.0};
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      // The angle between outward normals is pi minus the dihedral angle; atan2 keeps small angles exact.
      const double angle = std::atan2(length(cross(normal[i], normal[j])), -dot(normal[i], normal[j]));
      shape.smallest = std::min(shape.smallest, angle);
      shape.largest = std::max(shape.largest, angle);
    }
  // r = 3 V / areas; R = |a^2 (b x c) + b^2 (c x a) + c^2 (a x b)| / (12 V), a, b, c the edges from one corner.
  const dvec3 a = p[1] - p[0], b = p[2] - p[0], c = p[3] - p[0];
  const double six_volumes = dot(a, cross(b, c));
  const double reach = length(dot(a, a) * cross(b, c) + dot(b, b) * cross(c, a) + dot(c, c) * cross(a, b));
  if (six_volumes > 0.0 && areas > 0.0 && reach > 0.0)
    shape.ratio = 3.0 * (0.5 * six_volumes / areas) * (2.0 * six_volumes / reach);
  return shape;
}

}  // namespace

double tet_volume(std::span<const dvec3> nodes, const Tet& tet) {
  const dvec3 p = nodes[tet[0]];
  return dot(cross(nodes[tet[1]] - p, nodes[tet[2]] - p), nodes[tet[3]] - p) / 6.0;
}

double total_volume(const TetMesh& mesh) {
  double sum = 0.0;
  for (const Tet& tet : mesh.tets) sum += tet_volume(mesh.nodes, tet);
  return sum;
}

double tissue_volume(const TetMesh& mesh) {
  return mesh.volume.empty() ? total_volume(mesh) : std::accumulate(mesh.volume.begin(), mesh.volume.end(), 0.0);
}

TetQuality measure_quality(std::span<const dvec3> nodes, std::span<const Tet> tets) {
  TetQuality quality;
  if (tets.empty()) return quality;
  quality.smallest_dihedral = std::numbers::pi;
  std::vector<double> ratios;
  ratios.reserve(tets.size());
  for (const Tet& t : tets) {
    const TetShape shape = shape_of({nodes[t[0]], nodes[t[1]], nodes[t[2]], nodes[t[3]]});
    quality.smallest_dihedral = std::min(quality.smallest_dihedral, shape.smallest);
    quality.largest_dihedral = std::max(quality.largest_dihedral, shape.largest);
    ratios.push_back(shape.ratio);
  }
  quality.worst_ratio = *std::min_element(ratios.begin(), ratios.end());
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  quality.median_ratio = *middle;
  return quality;
}

}  // namespace pliant
