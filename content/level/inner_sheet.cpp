#include "content/level/inner_sheet.h"

#include <algorithm>
#include <set>

#include "content/tets/tet_embed.h"

namespace pliant {
namespace {

constexpr double kOff = 0.33;  // [cells] more than the lattice's faces stand off a bent surface

using SheetCorners = std::array<std::uint32_t, 3>;

SheetCorners sorted(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  SheetCorners corners{a, b, c};
  std::sort(corners.begin(), corners.end());
  return corners;
}

}  // namespace

std::vector<std::uint8_t> covered_triangles(const Mesh& mesh, const TetMesh& tissue) {
  std::vector<dvec3> off;
  for (const uvec3& t : mesh.triangles) {
    const dvec3 a(mesh.position(t.x)), b(mesh.position(t.y)), c(mesh.position(t.z));
    off.push_back((a + b + c) / 3.0 + kOff * tissue.report.cell * normalize(cross(b - a, c - a)));
  }
  return are_inside(off, tissue.nodes, tissue.tets);
}

bool leave_out_covered(const BuiltMesh& surface, const TetMesh& tissue, std::vector<Primitive>& primitives) {
  const Mesh& mesh = surface.mesh;
  const std::vector<std::uint8_t> inside = covered_triangles(mesh, tissue);
  std::set<SheetCorners> covered;
  for (std::size_t t = 0; t < inside.size(); ++t)
    if (inside[t]) covered.insert(sorted(mesh.triangles[t].x, mesh.triangles[t].y, mesh.triangles[t].z));
  if (covered.empty() || covered.size() == mesh.triangles.size()) return false;
  std::size_t first = 0;
  for (Primitive& p : primitives) {
    std::vector<std::uint32_t> kept;
    const auto at = [&](std::size_t corner) { return mesh.of_source[first + p.index[corner]]; };
    for (std::size_t i = 0; i + 2 < p.index.size(); i += 3)
      if (!covered.count(sorted(at(i), at(i + 1), at(i + 2))))
        kept.insert(kept.end(), p.index.begin() + static_cast<std::ptrdiff_t>(i),
                    p.index.begin() + static_cast<std::ptrdiff_t>(i + 3));
    p.index = std::move(kept);
    first += p.position.size();
  }
  std::erase_if(primitives, [](const Primitive& p) { return p.index.empty(); });
  return true;
}

}  // namespace pliant
