#include "content/tets/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "content/files/limits.h"
#include "content/tets/lattice_grid.h"
#include "content/tets/lattice_stuffing.h"
#include "content/tets/tet_embed.h"
#include "content/tets/tet_order.h"
#include "content/tets/tet_quality.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr int kTries = 10;          // at the usual number of tetrahedra
constexpr double kSamples = 20000;  // places in the box that tell about how much of it is enclosed
constexpr double kSure = 1.1;       // [1] of the limit: what is estimated above it is beyond it

// [1] About how many tetrahedra a cell makes: twelve for each cube of it in the volume, by the share of a regular grid
// of places that lie inside. Filling a box with millions only to find them too many takes half a minute.
double estimated_tets(const Mesh& surface, const Inside& inside, double cell) {
  const dvec3 low(surface.box.min), size(surface.box.size());
  const double step = std::cbrt(size.x * size.y * size.z / kSamples);
  if (!(step > 0.0)) return 0.0;
  const glm::ivec3 count = glm::max(glm::ivec3(glm::ceil(glm::min(size / step, dvec3(kSamples)))), glm::ivec3(1));
  const std::size_t all =
      static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) * static_cast<std::size_t>(count.z);
  if (static_cast<double>(all) > 50 * kSamples) return 0.0;  // flat: counted as it is filled
  std::vector<std::size_t> enclosed(static_cast<std::size_t>(count.z), 0);
  parallel_for(enclosed.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z)
      for (int y = 0; y < count.y; ++y)
        for (int x = 0; x < count.x; ++x)
          enclosed[z] += inside(low + size * (dvec3(x, y, static_cast<double>(z)) + 0.5) / dvec3(count));
  });
  const std::size_t sum = std::accumulate(enclosed.begin(), enclosed.end(), std::size_t{0});
  const double share = static_cast<double>(sum) / static_cast<double>(all);
  return 12.0 * share * size.x * size.y * size.z / (cell * cell * cell);
}

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
    if (LatticeGrid::node_count(surface.box, cell) > static_cast<double>(most(limits::kLatticeNodes))) break;
    Result<Stuffing> stuffing = stuff(surface, inside, cell, most(limits::kTets), progress);
    if (!stuffing) return stuffing;
    const double share = static_cast<double>(stuffing->tets.size()) / static_cast<double>(kUsualTets);
    best = std::move(*stuffing);
    if (share > 0.9 && share < 1.1) break;
    cell *= std::clamp(std::cbrt(share), 0.4, 2.5);
  }
  return best;
}

Result<Stuffing> stuff_cell(const Mesh& surface, const Inside& inside, double cell, Progress& progress) {
  const auto too_many = [&](const Limit& limit, double count) {
    return Error{"mesh `" + surface.name + "`", fmt::format("a cell of {:.3g} m makes {}", cell,
                                                            beyond(limit, std::ceil(count), "choose a larger one"))};
  };
  const double nodes = LatticeGrid::node_count(surface.box, cell);
  if (nodes > static_cast<double>(most(limits::kLatticeNodes))) return too_many(limits::kLatticeNodes, nodes);
  const double tets = estimated_tets(surface, inside, cell);
  if (tets > kSure * static_cast<double>(most(limits::kTets))) return too_many(limits::kTets, tets);
  return stuff(surface, inside, cell, most(limits::kTets), progress);
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
