#include "content/tets/lattice_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "content/files/limits.h"
#include "content/tets/lattice.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr int kCoarse = 4, kFine = 8;          // samples of a cell along each axis: to count cells, and to weigh them
constexpr double kOfBox = 1e-3;                // [1] variance that a single sample leaves, times samples squared
constexpr double kLeastShare = 0.02;           // [1] of a cell: one with less tissue is left out
constexpr int kCellTries = 8;                  // attempts to reach the usual number
constexpr double kMostUsualCells = 100'000.0;  // cells of the box per attempt

// The sum over samples of a cell.
struct CellTissue {
  double share = 0.0;          // [1]
  dvec3 mean{0}, products{0};  // [1] as in LatticeCell
  dvec3 spread{1.0 / 3.0};     // [1]
  double triple = 0.0;         // [1] mean of xyz
};

class CellGrid {
 public:
  CellGrid(const Box& box, double cell) : origin_(box.min) {
    const dvec3 size(box.size());
    for (int i = 0; i < 3; ++i) {
      count_[i] = std::max(1, static_cast<int>(std::lround(std::min(size[i] / cell, 1e6))));
      width_[i] = std::max(size[i] / count_[i], 1e-6 * cell);
    }
  }
  double size() const { return static_cast<double>(count_.x) * count_.y * count_.z; }
  glm::ivec3 count() const { return count_; }
  dvec3 corner(glm::ivec3 at) const { return origin_ + width_ * dvec3(at); }
  dvec3 width() const { return width_; }
  double volume() const { return width_.x * width_.y * width_.z; }

 private:
  dvec3 origin_, width_{0};  // [m]
  glm::ivec3 count_{1};
};

CellTissue tissue_in(const FillRegion& region, const CellGrid& grid, glm::ivec3 at, int samples) {
  CellTissue out;
  const dvec3 low = grid.corner(at), width = grid.width();
  if (region.is_uniform(low, low + width)) {
    out.share = region(low + 0.5 * width) ? 1.0 : 0.0;
    return out;
  }
  int inside = 0;
  dvec3 squares(0);
  for (int z = 0; z < samples; ++z)
    for (int y = 0; y < samples; ++y)
      for (int x = 0; x < samples; ++x) {
        // Each in a box of its own, at a place that no plane through the lattice's nodes meets again and again.
        const dvec3 in_box = glm::fract(
            dvec3(0.5 + 0.3820 * y + 0.6180 * z, 0.5 + 0.6180 * x + 0.3820 * z, 0.5 + 0.3820 * x + 0.6180 * y));
        const dvec3 own = 2.0 * (dvec3(x, y, z) + in_box) / static_cast<double>(samples) - 1.0;
        if (!region(low + 0.5 * width * (own + 1.0))) continue;
        ++inside;
        out.mean += own;
        out.products += dvec3(own.y * own.z, own.z * own.x, own.x * own.y);
        out.triple += own.x * own.y * own.z;
        squares += own * own;
      }
  const int all = samples * samples * samples;
  if (inside == 0) return out;
  if (inside == all) return {1.0};
  const double n = inside;
  out.share = n / all;
  out.mean /= n;
  out.products /= n;
  out.triple /= n;
  out.spread = squares / n - out.mean * out.mean + kOfBox / (samples * samples);
  return out;
}

std::vector<CellTissue> tissue_of(const FillRegion& region, const CellGrid& grid, int samples, LongWork& progress,
                                  const std::string& name, const std::stop_token& stop) {
  const glm::ivec3 count = grid.count();
  const auto layer = static_cast<std::size_t>(count.x) * static_cast<std::size_t>(count.y);
  std::vector<CellTissue> out(layer * static_cast<std::size_t>(count.z));
  for (int z = 0; z < count.z && !stop.stop_requested(); ++z) {
    parallel_for(layer, 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto x = static_cast<int>(i) % count.x, y = static_cast<int>(i) / count.x;
        out[layer * static_cast<std::size_t>(z) + i] = tissue_in(region, grid, {x, y, z}, samples);
      }
    });
    progress.say("filling `" + name + "` with cells");
  }
  return out;
}

// The six tetrahedra around the diagonal from corner 0 to corner 7, alike in all cells, so that they match.
void divide(const LatticeCell& cell, std::vector<Tet>& tets) {
  constexpr std::array<std::array<std::size_t, 2>, kTetsOfCell> kPaths{
      {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}}};
  for (const auto& [a, b] : kPaths) {
    const std::size_t first = std::min(a, b), second = std::max(a, b);
    const bool turned = first == a;
    tets.push_back(turned ? Tet{cell.nodes[0], cell.nodes[first], cell.nodes[second], cell.nodes[7]}
                          : Tet{cell.nodes[0], cell.nodes[second], cell.nodes[first], cell.nodes[7]});
  }
}

Error too_many(const std::string& where, double cell, double found) {
  return error_at(where, beyond(fmt::format("a cell of {:.3g} m makes", cell), limits::kTets, std::ceil(found),
                                "choose a larger one"));
}

}  // namespace

Result<double> fill_cells(const Mesh& surface, const FillRegion& region, double cell, LongWork& progress,
                          const std::stop_token& stop, TetMesh& mesh) {
  const std::string where = "mesh `" + surface.name + "`";
  const Box box = region.box();
  const dvec3 size(box.size());
  const auto ask = [&](const CellGrid& grid) -> Status {
    const double most_cells = static_cast<double>(most(limits::kLatticeNodes));
    if (grid.size() > most_cells)
      return error_at(where, beyond(fmt::format("a cell of {:.3g} m makes", cell), limits::kLatticeNodes,
                                    std::ceil(grid.size()), "choose a larger one"));
    return Done{};
  };
  if (!(cell > 0.0)) {
    const double longest = std::max({size.x, size.y, size.z});
    double volume = 1.0;
    for (int i = 0; i < 3; ++i) volume *= std::max(size[i], 0.01 * longest);
    const double wanted = static_cast<double>(kUsualTets) / kTetsOfCell;
    double nearest = std::numeric_limits<double>::infinity(), next = std::cbrt(0.5 * volume / wanted);
    cell = next;
    for (int n = 0; n < kCellTries; ++n) {
      const CellGrid grid(box, next);
      if (grid.size() > kMostUsualCells) break;
      const std::vector<CellTissue> tissue = tissue_of(region, grid, kCoarse, progress, surface.name, stop);
      if (stop.stop_requested()) return Error{where, "its filling was stopped", "nothing is wrong with it"};
      const auto found = static_cast<double>(
          std::count_if(tissue.begin(), tissue.end(), [](const CellTissue& t) { return t.share >= kLeastShare; }));
      const double off = std::abs(std::log(std::max(found, 0.1) / wanted));
      if (off < nearest) nearest = off, cell = next;
      if (off < 0.1) break;
      next *= std::clamp(std::cbrt(std::max(found, 0.1) / wanted), 0.4, 2.5);
    }
  }
  const CellGrid grid(box, cell);
  if (Status s = ask(grid); !s) return s.error();
  const std::vector<CellTissue> tissue = tissue_of(region, grid, kFine, progress, surface.name, stop);
  if (stop.stop_requested()) return Error{where, "its filling was stopped", "nothing is wrong with it"};

  const glm::ivec3 count = grid.count();
  std::vector<std::uint32_t> number(static_cast<std::size_t>(count.x + 1) * static_cast<std::size_t>(count.y + 1) *
                                        static_cast<std::size_t>(count.z + 1),
                                    kBorder);
  std::size_t next = 0;
  for (int z = 0; z < count.z; ++z)
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x) {
        const CellTissue& its = tissue[next++];
        if (its.share < kLeastShare) continue;
        LatticeCell& made = mesh.cells.emplace_back();
        made.share = its.share;
        made.mean = its.mean;
        made.products = its.products;
        made.spread = its.spread;
        for (std::size_t k = 0; k < 8; ++k) {
          const glm::ivec3 way(k & 1, k >> 1 & 1, k >> 2 & 1), at = glm::ivec3(x, y, z) + way;
          std::uint32_t& node = number[static_cast<std::size_t>((at.z * (count.y + 1) + at.y) * (count.x + 1) + at.x)];
          if (node == kBorder) {
            node = static_cast<std::uint32_t>(mesh.nodes.size());
            mesh.nodes.push_back(grid.corner(at));
            mesh.volume.push_back(0.0);
          }
          made.nodes[k] = node;
          // The shape function's integral over the tissue.
          const dvec3 s = 2.0 * dvec3(way) - 1.0;
          mesh.volume[node] += 0.125 * its.share * grid.volume() *
                               (1.0 + dot(s, its.mean) + s.y * s.z * its.products.x + s.z * s.x * its.products.y +
                                s.x * s.y * its.products.z + s.x * s.y * s.z * its.triple);
        }
        divide(made, mesh.tets);
      }
  if (mesh.tets.size() > most(limits::kTets)) return too_many(where, cell, static_cast<double>(mesh.tets.size()));
  mesh.free_count = mesh.node_count();
  return mesh.cells.empty() ? 0.0 : cell;
}

}  // namespace pliant
