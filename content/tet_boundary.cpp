#include "content/tet_boundary.h"

#include <algorithm>

namespace pliant {
namespace {

struct Face {
  std::array<std::uint32_t, 3> key;  // ascending
  std::uint32_t number;              // 4 * tet + the corner over against it
};

// Outward faces of a tetrahedron of positive volume, each over against its corner.
constexpr std::size_t kFace[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

}  // namespace

std::vector<uvec3> boundary_triangles(std::span<const Tet> tets) {
  std::vector<Face> faces;
  faces.reserve(4 * tets.size());
  for (std::uint32_t t = 0; t < tets.size(); ++t)
    for (std::uint32_t f = 0; f < 4; ++f) {
      Face face{{tets[t][kFace[f][0]], tets[t][kFace[f][1]], tets[t][kFace[f][2]]}, 4 * t + f};
      std::sort(face.key.begin(), face.key.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.key != b.key ? a.key < b.key : a.number < b.number; });

  std::vector<std::uint32_t> alone;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].key == faces[i].key) ++j;
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
