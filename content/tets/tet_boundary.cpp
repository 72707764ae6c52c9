#include "content/tets/tet_boundary.h"

#include <algorithm>

namespace pliant {
namespace {

// Outward faces of a tetrahedron of positive volume, each opposite its corner.
constexpr std::size_t kFace[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

}  // namespace

std::vector<TetFace> sorted_faces(std::span<const Tet> tets) {
  std::vector<TetFace> faces;
  faces.reserve(4 * tets.size());
  for (std::uint32_t t = 0; t < tets.size(); ++t)
    for (std::uint32_t f = 0; f < 4; ++f) {
      TetFace face{{tets[t][kFace[f][0]], tets[t][kFace[f][1]], tets[t][kFace[f][2]]}, 4 * t + f};
      std::sort(face.nodes.begin(), face.nodes.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end(), [](const TetFace& a, const TetFace& b) {
    return a.nodes != b.nodes ? a.nodes < b.nodes : a.number < b.number;
  });
  return faces;
}

std::vector<uvec3> boundary_triangles(std::span<const Tet> tets) {
  const std::vector<TetFace> faces = sorted_faces(tets);
  std::vector<std::uint32_t> alone;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].nodes == faces[i].nodes) ++j;
    if (j - i == 1) alone.push_back(faces[i].number);
    i = j;
  }
  std::sort(alone.begin(), alone.end());
  std::vector<uvec3> triangles;
  triangles.reserve(alone.size());
  for (const std::uint32_t number : alone) {
    const Tet& tet = tets[number / 4];
    const auto& f = kFace[number % 4];
    triangles.emplace_back(tet[f[0]], tet[f[1]], tet[f[2]]);
  }
  return triangles;
}

}  // namespace pliant
