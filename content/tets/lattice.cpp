#include "content/tets/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/tets/lattice_grid.h"
#include "content/tets/lattice_stuffing.h"
#include "content/tets/tet_embed.h"
#include "content/tets/tet_order.h"
#include "content/tets/tet_quality.h"

namespace pliant {
namespace {

constexpr double kMostNodes = 1 << 24;  // of the lattice over the surface's box
constexpr int kTries = 10;              // at the usual number of tetrahedra

// The cell whose stuffing has about kUsualTets tetrahedra: their number goes with the cube of the cell. Begins where a
// box filled by a third would need no change.
Result<Stuffing> stuff_usual(const Mesh& surface, const Inside& inside, Progress& progress) {
  const dvec3 size(surface.box.size());
  const double longest = std::max({size.x, size.y, size.z});
  double volume = 1.0;
  for (int i = 0; i < 3; ++i) volume *= std::max(size[i], 0.01 * longest);
  double cell = std::cbrt(12.0 * 0.33 * volume / static_cast<double>(kUsualTets));
  Stuffing best;
  for (int n = 0; n < kTries; ++n) {
    if (LatticeGrid::node_count(surface.box, cell) > kMostNodes) break;
    Result<Stuffing> stuffing = stuff(surface, inside, cell, kMostTets, progress);
    if (!stuffing) return stuffing;
    const double share = static_cast<double>(stuffing->tets.size()) / static_cast<double>(kUsualTets);
    best = std::move(*stuffing);
    if (share > 0.9 && share < 1.1) break;
    cell *= std::clamp(std::cbrt(share), 0.4, 2.5);
  }
  return best;
}

Result<Stuffing> stuff_cell(const Mesh& surface, const Inside& inside, double cell, Progress& progress) {
  const Error too_many{"mesh `" + surface.name + "`",
                       fmt::format("a cell of {:.3g} m makes more than {} cells over its box; choose a larger one",
                                   cell, static_cast<int>(kMostNodes) / 2)};
  if (LatticeGrid::node_count(surface.box, cell) > kMostNodes) return too_many;
  return stuff(surface, inside, cell, kMostTets, progress);
}

}  // namespace

Result<TetMesh> make_lattice(const Mesh& surface, double cell) {
  if (!(cell >= 0.0) || !std::isfinite(cell))
    return Error{"mesh `" + surface.name + "`",
                 "its cell is not a length; give it in metres, or 0 for one sized from the bounds"};
  Progress progress;
  const Inside inside(surface);
  Result<Stuffing> stuffing =
      cell > 0.0 ? stuff_cell(surface, inside, cell, progress) : stuff_usual(surface, inside, progress);
  if (!stuffing) return stuffing.error();
  if (stuffing->tets.empty())
    return Error{"mesh `" + surface.name + "`",
                 "holds no tetrahedra: it encloses nothing, or is thinner than the cell; close it, or make `cell` "
                 "smaller"};
  TetMesh mesh;
  mesh.name = surface.name;
  mesh.nodes = std::move(stuffing->nodes);
  mesh.tets = std::move(stuffing->tets);
  put_in_order(mesh, {});
  mesh.embedding = embed(surface, mesh.nodes, mesh.tets);
  mesh.quality = measure_quality(mesh.nodes, mesh.tets);
  return mesh;
}

}  // namespace pliant
