#include "lab/study/shapes/block_press.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "lab/study/pareto.h"
#include "lab/study/processor_time.h"
#include "runtime/assert.h"
#include "systems/soft/fem/tissue.h"
#include "systems/soft/fem/tissue_step.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {
namespace {

constexpr double kRim = 1.5;              // [1] > 1: cells get smaller towards the rim
constexpr int kMostBlockIterations = 60;  // co-rotational iterations per depth

// Coordinates from 0 to `end` in `parts * cells` cells: t^kRim near 0, then increasing. The curve is the same for all
// `cells`, so that errors decrease uniformly with their number.
std::vector<double> away_from_rim(double radius, double end, int parts, int cells) {
  const double growth = std::log(end / (radius * std::pow(parts, kRim)));
  std::vector<double> at;
  for (int i = 0; i <= parts * cells; ++i) {
    const double t = static_cast<double>(i) / cells;
    at.push_back(radius * std::pow(t, kRim) * std::exp(growth * t / parts));
  }
  return at;
}

struct Grid {
  std::vector<double> side, depth;  // coordinates along x and z, and downwards
  std::size_t across() const { return side.size(); }
};

Grid grid_of(const BlockPress& p) {
  Grid grid;
  std::vector<double> half;
  for (int i = 0; i < p.cells; ++i)
    half.push_back(p.radius * (1 - std::pow(1 - static_cast<double>(i) / p.cells, kRim)));
  for (const double away : away_from_rim(p.radius, p.half_width - p.radius, 2, p.cells))
    half.push_back(p.radius + away);
  for (auto x = half.rbegin(); x != half.rend(); ++x)
    if (*x > 0.0) grid.side.push_back(-*x);
  grid.side.insert(grid.side.end(), half.begin(), half.end());
  const int parts = 1 + std::max(0, static_cast<int>(std::lround(std::log2(p.thickness / p.radius))));
  grid.depth = away_from_rim(p.radius, p.thickness, parts, p.cells);
  return grid;
}

enum class Group { kFree, kPunch, kFloor };

// Maps squares around the centre to circles at the punch's rim, and back to squares at the block's sides. The punch is
// then a disc on every grid, except for the arcs between its nodes.
dvec3 rounded(dvec3 p, const BlockPress& press) {
  const double m = std::max(std::abs(p.x), std::abs(p.z)), a = press.radius;
  if (m == 0.0) return p;
  const double round = m <= a ? m / a : std::max(0.0, (press.half_width - m) / (press.half_width - a));
  const double scale = 1 + round * (m / std::hypot(p.x, p.z) - 1);
  return {scale * p.x, p.y, scale * p.z};
}

// Six tetrahedra per cell around its diagonal; neighbours are mirrored, so that no direction is preferred.
TetMesh tets_of(const Grid& grid, const BlockPress& p) {
  TetMesh mesh;
  mesh.name = "block";
  const std::size_t n = grid.across(), deep = grid.depth.size();
  std::vector<dvec3> places;
  std::vector<Group> group;
  for (const double x : grid.side)
    for (const double z : grid.side)
      for (std::size_t k = 0; k < deep; ++k) {
        places.push_back(rounded({x, -grid.depth[k], z}, p));
        const bool under = std::max(std::abs(x), std::abs(z)) <= p.radius * (1 + 1e-9);
        group.push_back(k + 1 == deep ? Group::kFloor : k == 0 && under ? Group::kPunch : Group::kFree);
      }
  std::vector<std::uint32_t> name(places.size());
  for (const Group g : {Group::kFree, Group::kPunch, Group::kFloor}) {
    for (std::size_t i = 0; i < places.size(); ++i)
      if (group[i] == g) {
        name[i] = mesh.node_count();
        mesh.nodes.push_back(places[i]);
      }
    if (g == Group::kFree) mesh.free_count = mesh.node_count();
    if (g == Group::kPunch) mesh.handle_count = mesh.node_count() - mesh.free_count;
  }
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (std::size_t i = 0; i + 1 < n; ++i)
    for (std::size_t j = 0; j + 1 < n; ++j)
      for (std::size_t k = 0; k + 1 < deep; ++k)
        for (const auto& order : kOrders) {
          const std::array<std::size_t, 3> cell{i, j, k};
          std::array<std::size_t, 3> at;
          for (std::size_t d = 0; d < 3; ++d) at[d] = cell[d] + cell[d] % 2;
          Tet tet{};
          const auto node = [&] { return name[(at[0] * n + at[1]) * deep + at[2]]; };
          tet[0] = node();
          for (std::size_t step = 0; step < 3; ++step) {
            const auto d = static_cast<std::size_t>(order[step]);
            at[d] = cell[d] + (1 - cell[d] % 2);
            tet[step + 1] = node();
          }
          const dvec3 a = mesh.nodes[tet[0]];
          if (dot(cross(mesh.nodes[tet[1]] - a, mesh.nodes[tet[2]] - a), mesh.nodes[tet[3]] - a) < 0)
            std::swap(tet[2], tet[3]);
          mesh.tets.push_back(tet);
        }
  return mesh;
}

// Surface deflection, positive downwards: means over the rings of the top.
void read_top(const TetMesh& mesh, const Tissue& tissue, double punch, PressedBlock& out) {
  std::map<long, std::pair<double, double>> rings;  // by radius: sum of the shares and count
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) {
    const dvec3 x = mesh.nodes[i];
    if (x.y != 0.0) continue;
    auto& [sum, count] = rings[std::lround(std::hypot(x.x, x.z) / punch * 1e6)];
    sum -= (tissue.position()[i].y - x.y) / out.depth;
    count += 1.0;
  }
  for (const auto& [at, ring] : rings) {
    out.radius.push_back(static_cast<double>(at) * 1e-6 * punch);
    out.share.push_back(ring.first / ring.second);
  }
}

}  // namespace

Result<std::vector<PressedBlock>> press_block(const BlockPress& press, const std::vector<double>& depths,
                                              const std::function<bool(double)>& goes_on) {
  const TetMesh mesh = tets_of(grid_of(press), press);
  TissueMaterial material;
  material.young = press.young;
  material.poisson = press.poisson;
  material.strain = press.strain;
  TissueStep settle;
  if (press.strain == Strain::kCorotational) settle.iterations = kMostBlockIterations, settle.tolerance = 1e-7;
  Tissue tissue(mesh, material, mesh.free_count);
  const auto solver = make_solver(SolverKind::kBlockCholesky, tissue.inner().size);
  solver->analyse(tissue.inner());
  std::uint64_t begin = processor_ns();
  std::vector<PressedBlock> all;
  double before = 0.0;
  for (const double depth : depths) {
    if (!goes_on(static_cast<double>(all.size()) / static_cast<double>(depths.size()))) return interrupted();
    PressedBlock out;
    out.depth = depth;
    out.tets = mesh.tets.size();
    for (std::uint32_t i = mesh.free_count; i < mesh.pinned_begin(); ++i) tissue.position()[i].y -= depth - before;
    const TissueReport report = settle_tissue(tissue, *solver, dvec3(0), settle);
    if (!report.solved || (press.strain == Strain::kCorotational && !(report.change <= settle.tolerance)))
      return Error{"study",
                   fmt::format("a block of {} tetrahedra, pressed {:g} mm deep, was not solved; this is a defect "
                               "of the study",
                               out.tets, 1000 * depth)};
    out.solves = report.iterations;
    tissue.assemble(1.0, dvec3(0));
    for (std::uint32_t i = mesh.free_count; i < mesh.pinned_begin(); ++i)
      out.force += tissue.elastic_force()[3 * i + 1];
    out.ms = static_cast<double>(processor_ns() - begin) * 1e-6;
    read_top(mesh, tissue, press.radius, out);
    all.push_back(std::move(out));
    before = depth;
    begin = processor_ns();
  }
  return all;
}

Result<PressedBlock> press_block(const BlockPress& press, double depth) {
  auto all = press_block(press, std::vector<double>{depth});
  if (!all) return all.error();
  return std::move(all->front());
}

GridLimit grid_limit(const std::vector<int>& cells, const std::vector<double>& values) {
  ASSERT(cells.size() == values.size() && cells.size() >= 3);
  const auto last = values.end() - 3;
  const auto n = cells.end() - 3;
  const auto fall = [&](double order, int i) { return std::pow(n[i], -order) - std::pow(n[i + 1], -order); };
  const double ratio = (last[0] - last[1]) / (last[1] - last[2]);
  constexpr double kLeastOrder = 0.25, kMostOrder = 6.0;
  double low = kLeastOrder, high = kMostOrder;
  if (!(ratio > fall(low, 0) / fall(low, 1) && ratio < fall(high, 0) / fall(high, 1)))
    return {last[2], std::numeric_limits<double>::quiet_NaN(), 0.0};
  for (int i = 0; i < 60; ++i) {
    const double order = 0.5 * (low + high);
    (fall(order, 0) / fall(order, 1) < ratio ? low : high) = order;
  }
  const double to_come = std::pow(n[2], -low) / fall(low, 1);
  return {last[2] + to_come * (last[2] - last[1]), low, to_come};
}

}  // namespace pliant
