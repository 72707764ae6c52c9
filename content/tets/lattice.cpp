#include "content/tets/lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "content/files/limits.h"
#include "content/tets/lattice_cells.h"
#include "content/tets/lattice_stuffing.h"
#include "content/tets/tet_embed.h"
#include "content/tets/tet_findings.h"
#include "content/tets/tet_mass.h"
#include "content/tets/tet_order.h"
#include "content/tets/tet_quality.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr int kTries = 10;          // attempts to reach the usual number of tetrahedra
constexpr double kSamples = 20000;  // sample points in the box that estimate its enclosed share
constexpr double kSure = 1.1;       // [1] of the limit: estimates above it are rejected

// [1] Estimated number of tetrahedra for a cell: twelve per cell cube of the volume, which is sampled on a regular
// grid. Filling a box with millions before rejecting them would take half a minute.
double estimated_tets(const FillRegion& region, double cell) {
  const Box box = region.box();
  const dvec3 low(box.min), size(box.size());
  const double step = std::cbrt(size.x * size.y * size.z / kSamples);
  if (!(step > 0.0)) return 0.0;
  const glm::ivec3 count = glm::max(glm::ivec3(glm::ceil(glm::min(size / step, dvec3(kSamples)))), glm::ivec3(1));
  const std::size_t all =
      static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y) * static_cast<std::size_t>(count.z);
  if (static_cast<double>(all) > 50 * kSamples) return 0.0;  // flat: counted during filling
  std::vector<std::size_t> enclosed(static_cast<std::size_t>(count.z), 0);
  parallel_for(enclosed.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z)
      for (int y = 0; y < count.y; ++y)
        for (int x = 0; x < count.x; ++x)
          enclosed[z] += region(low + size * (dvec3(x, y, static_cast<double>(z)) + 0.5) / dvec3(count));
  });
  const std::size_t sum = std::accumulate(enclosed.begin(), enclosed.end(), std::size_t{0});
  const double share = static_cast<double>(sum) / static_cast<double>(all);
  return kTetsPerCell * share * size.x * size.y * size.z / (cell * cell * cell);
}

struct Found {
  double cell = 0.0;  // [m]
  Stuffing stuffing;
};

// Finds the cell that gives about kUsualTets tetrahedra; their number scales with the cell's inverse cube. Starts at
// the cell that is right for a box filled by a third. For objects thinner than their cell the number is erratic; the
// nearest of all attempts is then used.
Result<Found> stuff_usual(const Mesh& surface, const FillRegion& region, const LatticeOptions& options,
                          LongWork& progress) {
  const Box box = region.box();
  const dvec3 size(box.size());
  const double longest = std::max({size.x, size.y, size.z});
  double volume = 1.0;
  for (int i = 0; i < 3; ++i) volume *= std::max(size[i], 0.01 * longest);
  double cell = std::cbrt(12.0 * 0.33 * volume / static_cast<double>(kUsualTets));
  Found best;
  for (int n = 0; n < kTries; ++n) {
    if (LatticeGrid::node_count(box, cell, options.focus) > kMostUsualNodes) break;
    const LatticeGrid grid(box, cell, options.focus);
    Result<Stuffing> stuffing = stuff(surface, region, grid, kMostUsualTets, progress, options.stop);
    if (!stuffing) return stuffing.error();
    const double share = static_cast<double>(stuffing->tets.size()) / static_cast<double>(kUsualTets);
    const auto off = [](std::size_t tets) {
      return std::abs(std::log(static_cast<double>(tets) / static_cast<double>(kUsualTets)));
    };
    const bool usual = share > 0.9 && share < 1.1;
    if (!stuffing->beyond && !stuffing->tets.empty() &&
        (usual || best.stuffing.tets.empty() || off(stuffing->tets.size()) < off(best.stuffing.tets.size())))
      best = {cell, std::move(*stuffing)};
    if (usual) break;
    cell *= std::clamp(std::cbrt(share), 0.4, 2.5);
  }
  return best;
}

Result<Found> stuff_cell(const Mesh& surface, const FillRegion& region, const LatticeOptions& options,
                         LongWork& progress) {
  const double cell = options.cell;
  const std::string where = "mesh `" + surface.name + "`", makes = fmt::format("a cell of {:.3g} m makes", cell);
  const auto count = [&](const Limit& limit, double found) {
    return error_at(where, beyond(makes, limit, std::ceil(found), "choose a larger one"));
  };
  const double nodes = LatticeGrid::node_count(region.box(), cell, options.focus);
  if (nodes > static_cast<double>(most(limits::kLatticeNodes))) return count(limits::kLatticeNodes, nodes);
  // Where a full box would not have too many there is nothing to estimate.
  const dvec3 size(region.box().size());
  const bool may_be_beyond =
      kTetsPerCell * size.x * size.y * size.z / (cell * cell * cell) > static_cast<double>(most(limits::kTets));
  const double tets = may_be_beyond && !options.focus ? estimated_tets(region, cell) : 0.0;
  if (tets > kSure * static_cast<double>(most(limits::kTets))) return count(limits::kTets, tets);
  const LatticeGrid grid(region.box(), cell, options.focus);
  Result<Stuffing> stuffing = stuff(surface, region, grid, most(limits::kTets), progress, options.stop);
  if (!stuffing) return stuffing.error();
  if (stuffing->beyond)
    return Error{where, fmt::format("{} more than {} tetrahedra", makes, most(limits::kTets)),
                 "choose a larger one, or allow it with --limits 2", "limit.exceeded"};
  return Found{cell, std::move(*stuffing)};
}

// Why nothing could be filled, and the remedy.
Error nothing_held(const Mesh& surface, const SurfaceShape& shape, const LatticeOptions& options) {
  const std::string where = "mesh `" + surface.name + "`";
  const bool sheet = shape.kind == SurfaceKind::kSheet;
  if (sheet && options.fill == Fill::kWall && options.thickness > 0.0)
    return {
        where,
        fmt::format("holds no tetrahedra: its layer of {} is thinner than the cell", length_text(options.thickness)),
        "make `thickness` larger or `cell` smaller"};
  if (shape.kind == SurfaceKind::kWall && options.fill == Fill::kWall)
    return {
        where,
        fmt::format("holds no tetrahedra: a wall of {} is thinner than any usual cell", length_text(shape.thickness)),
        fmt::format("fill the inside (\"fill\": \"solid\"), or give it a `thickness` of at least {}",
                    length_text(least_wall(surface, true))),
        kFillNote};
  if (sheet)
    return {where, "holds no tetrahedra: it is an open surface that encloses nothing",
            "close it, or give it a thickness (\"fill\": \"wall\", \"thickness\" in metres)"};
  return {where, "holds no tetrahedra: it encloses nothing, or is thinner than the cell",
          "close it, or make `cell` smaller"};
}

}  // namespace

Result<TetMesh> fill_surface(const Mesh& surface, const LatticeOptions& options) {
  if (!(options.cell >= 0.0) || !std::isfinite(options.cell))
    return Error{"mesh `" + surface.name + "`", "its cell is not a length",
                 "give it in metres, or 0 for one sized from the bounds"};
  if (!(options.thickness >= 0.0) || !std::isfinite(options.thickness))
    return Error{"mesh `" + surface.name + "`", "its thickness is not a length", "give it in metres"};
  LongWork progress;
  const SurfaceShape shape = measure_shape(surface);
  const Inside inside(surface);
  const FillRegion region(surface, inside, shape, options.fill, options.thickness);
  if (shape.kind == SurfaceKind::kSheet && options.fill == Fill::kWall && !(options.thickness > 0.0))
    return nothing_held(surface, shape, options);
  TetMesh mesh;
  mesh.name = surface.name;
  if (options.elements == Elements::kHexahedra) {
    if (options.focus)
      return Error{"mesh `" + surface.name + "`", "has a `focus`, and hexahedra are of one size",
                   "leave out `focus`, or take `elements` `tetrahedra`"};
    const Result<double> cell = fill_cells(surface, region, options.cell, progress, options.stop, mesh);
    if (!cell) return cell.error();
    mesh.report.cell = *cell;
  } else {
    Result<Found> found = options.cell > 0.0 ? stuff_cell(surface, region, options, progress)
                                             : stuff_usual(surface, region, options, progress);
    if (!found) return found.error();
    mesh.nodes = std::move(found->stuffing.nodes);
    mesh.tets = std::move(found->stuffing.tets);
    mesh.report.cell = found->cell;
  }
  if (mesh.tets.empty()) return nothing_held(surface, shape, options);
  match_mass(mass_of(surface, region, region.is_enclosed()), mesh);
  put_in_order(mesh, {});
  mesh.quality = measure_quality(mesh.nodes, mesh.tets);
  mesh.report.coarsest = mesh.report.cell;
  if (options.focus)
    for (const dvec3& node : mesh.nodes)
      mesh.report.coarsest = std::max(mesh.report.coarsest, mesh.report.cell * options.focus->width_at(node));
  report_wall(shape, options.fill, options.thickness, mesh.report);
  report_thin_places(shape, region, options, mesh);
  return mesh;
}

Result<TetMesh> make_lattice(const Mesh& surface, double cell) {
  Result<TetMesh> mesh = fill_surface(surface, {cell, Fill::kSolid, 0.0, {}});
  if (mesh) mesh->embedding = embed(surface, mesh->nodes, mesh->tets);
  return mesh;
}

}  // namespace pliant
