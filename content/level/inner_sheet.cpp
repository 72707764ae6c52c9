#include "content/level/inner_sheet.h"

#include <algorithm>
#include <set>

#include "content/tets/fill_region.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr double kOff = 0.5;  // [1] of the wall's thickness

using SheetCorners = std::array<std::uint32_t, 3>;

SheetCorners sorted(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  SheetCorners corners{a, b, c};
  std::sort(corners.begin(), corners.end());
  return corners;
}

}  // namespace

InnerSheet find_inner_sheet(const Mesh& mesh) {
  InnerSheet out;
  out.inner.assign(mesh.triangles.size(), 0);
  const SurfaceShape shape = measure_shape(mesh);
  if (shape.kind != SurfaceKind::kWall) return out;
  out.wall = shape.thickness;
  const Inside inside(mesh);
  const FillRegion filled(mesh, inside, shape, Fill::kSolid, 0.0);
  parallel_for(out.inner.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const uvec3 t = mesh.triangles[i];
      const dvec3 a(mesh.position(t.x)), b(mesh.position(t.y)), c(mesh.position(t.z)), twice = cross(b - a, c - a);
      const double size = length(twice);
      out.inner[i] = size > 0 && filled((a + b + c) / 3.0 + kOff * out.wall / size * twice);
    }
  });
  return out;
}

bool leave_out(const InnerSheet& sheet, const Mesh& mesh, std::vector<Primitive>& primitives) {
  std::set<SheetCorners> covered;
  for (std::size_t t = 0; t < sheet.inner.size(); ++t)
    if (sheet.inner[t]) covered.insert(sorted(mesh.triangles[t].x, mesh.triangles[t].y, mesh.triangles[t].z));
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
