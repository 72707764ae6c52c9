#include "editor/paint/coarse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/mesh/mesh_finer.h"
#include "content/mesh/touch_mesh.h"

namespace pliant {
namespace {

double longest_edge(const Mesh& mesh, const std::vector<std::uint32_t>& triangles) {
  double longest2 = 0.0;
  for (const std::uint32_t t : triangles)
    for (int i = 0; i < 3; ++i) {
      const dvec3 along =
          dvec3(mesh.position(mesh.triangles[t][(i + 1) % 3])) - dvec3(mesh.position(mesh.triangles[t][i]));
      longest2 = std::max(longest2, dot(along, along));
    }
  return std::sqrt(longest2);
}

std::size_t triangles_of(const LevelMesh& mesh) {
  std::size_t count = 0;
  for (const Primitive& p : mesh.primitives) count += p.index.size() / 3;
  return count;
}

double mm(double metres) {
  return 1e3 * metres;
}

// Triangles that are not in the touch mesh (degenerate or duplicate) are kept in the file.
void keep_the_rest(const LevelMesh& mesh, const TouchMesh& touch, std::vector<Primitive>& finer) {
  std::vector<std::uint8_t> taken(touch.gathered.triangle.size(), 0);
  for (const std::uint32_t t : touch.welded.source_triangle) taken[t] = 1;
  for (const std::uint32_t t : touch.welded.backs) taken[t] = 1;
  std::size_t first = 0;
  for (std::size_t n = 0; n < mesh.primitives.size(); ++n) {
    const std::vector<std::uint32_t>& index = mesh.primitives[n].index;
    for (std::size_t i = 0; i < index.size(); i += 3)
      if (!taken[first + i / 3]) finer[n].index.insert(finer[n].index.end(), {index[i], index[i + 1], index[i + 2]});
    first += index.size() / 3;
  }
}

}  // namespace

std::optional<CoarseMesh> coarse_for(const Brush& brush, const PaintSurface& surface, const SurfaceHit& hit,
                                     MarchWork& work) {
  // Only the inner half: a large triangle touched by the rim does not matter.
  const double edge = longest_edge(surface.mesh(), surface.triangles_under(hit, 0.5 * brush.radius, work));
  const double most = kSpared * kEdgeOfReach * brush.radius;
  if (!(edge > most)) return std::nullopt;
  return CoarseMesh{edge, kEdgeOfReach * brush.radius,
                    fmt::format("the mesh here has edges of {:.3g} mm, and a brush with a radius of {:.3g} mm wants "
                                "at most {:.3g} mm; refine it here, or use a radius of at least {:.3g} mm",
                                mm(edge), mm(brush.radius), mm(most), mm(edge / (kSpared * kEdgeOfReach)))};
}

Result<RefinedMesh> refine_under(const LevelMesh& mesh, const PaintSurface& surface, const SurfaceHit& hit,
                                 double radius, double edge) {
  ASSERT(hit.valid());
  const std::string where = "mesh `" + mesh.name + "`";
  if (!(radius > 0.0 && edge > 0.0 && std::isfinite(radius + edge)))
    return Error{where, "refining wants a radius and an edge length above 0"};
  // In the mesh frame and with the file's winding, so that no conversion back is needed.
  Result<TouchMesh> touch = build_touch_mesh(mesh.name, mesh.primitives, mat4(1.0f), {.mend_winding = false});
  if (!touch) return touch.error();

  FinerPlace place{surface.frame(), hit.point, radius, edge, {}};
  place.near.assign(touch->gathered.triangle.size(), 0);
  std::vector<std::size_t> first(mesh.primitives.size() + 1, 0);
  for (std::size_t n = 0; n < mesh.primitives.size(); ++n)
    first[n + 1] = first[n] + mesh.primitives[n].index.size() / 3;
  MarchWork work;
  // Limit of the region in which edges are shortened: where half the distance equals the longest edge.
  const double longest = longest_edge(surface.mesh(), surface.triangles_under(hit, radius, work));
  for (const std::uint32_t t : surface.triangles_under(hit, radius + 2.0 * longest, work)) {
    const SourceTriangle source = surface.source_triangle(t);
    place.near[first[source.primitive] + source.triangle] = 1;
  }

  RefinedMesh out{mesh, triangles_of(mesh), triangles_of(mesh), {}};
  FinerMesh finer = make_finer_at(place, mesh.primitives, touch->gathered, touch->welded, touch->mesh);
  if (finer.primitives.empty()) {
    out.sentence = finer.complete ? fmt::format("the mesh here has no edge longer than {:.3g} mm", mm(edge))
                                  : fmt::format(
                                        "edges of {:.3g} mm here would add more than {} triangles; ask for "
                                        "longer ones, or refine a smaller place",
                                        mm(edge), kMostAdded);
    return out;
  }
  keep_the_rest(mesh, *touch, finer.primitives);
  for (std::size_t n = 0; n < mesh.primitives.size(); ++n)  // -0, which gathering replaces by 0
    std::copy(mesh.primitives[n].position.begin(), mesh.primitives[n].position.end(),
              finer.primitives[n].position.begin());
  out.mesh.primitives = std::move(finer.primitives);
  out.triangles_after = triangles_of(out.mesh);
  out.sentence = fmt::format("{} triangles became {}, with edges of at most {:.3g} mm within {:.3g} mm",
                             out.triangles_before, out.triangles_after, mm(edge), mm(radius));
  if (!finer.complete)
    out.sentence = fmt::format("{} triangles became {}; edges of {:.3g} mm would add more than {}, so some stay longer",
                               out.triangles_before, out.triangles_after, mm(edge), kMostAdded);
  return out;
}

}  // namespace pliant
