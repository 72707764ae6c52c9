#include "player/study/block_press.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "player/study/processor_time.h"
#include "systems/soft/fem/tissue.h"
#include "systems/soft/fem/tissue_step.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {
namespace {

// From 0 to `end`: even cells of `size` as far as `fine`, then each `growth` times the one before; the last ones even
// out.
std::vector<double> graded(double fine, double size, double end, double growth) {
  std::vector<double> at{0.0};
  while (at.back() < fine - 1e-9 * size) at.push_back(at.back() + size);
  const std::size_t inner = at.size();
  for (double step = size * growth; at.back() < end; step *= growth) at.push_back(at.back() + step);
  const double begin = at[inner - 1], scale = (end - begin) / (at.back() - begin);
  for (std::size_t i = inner; i < at.size(); ++i) at[i] = begin + (at[i] - begin) * scale;
  return at;
}

struct Grid {
  std::vector<double> side, depth;  // coordinates along x and z, and downwards
  std::size_t across() const { return side.size(); }
};

Grid grid_of(const BlockPress& p) {
  const double size = p.radius / p.cells;
  Grid grid;
  const std::vector<double> half = graded(1.5 * p.radius, size, p.half_width, 1.3);
  for (auto x = half.rbegin(); x != half.rend(); ++x)
    if (*x > 0.0) grid.side.push_back(-*x);
  grid.side.insert(grid.side.end(), half.begin(), half.end());
  grid.depth = graded(p.radius, size, p.thickness, 1.3);
  return grid;
}

enum class Group { kFree, kPunch, kFloor };

// Six tetrahedra a cell around its diagonal; neighbours mirror one another, so that no direction is preferred.
TetMesh tets_of(const Grid& grid, const BlockPress& p) {
  TetMesh mesh;
  mesh.name = "block";
  const std::size_t n = grid.across(), deep = grid.depth.size();
  std::vector<dvec3> places;
  std::vector<Group> group;
  for (const double x : grid.side)
    for (const double z : grid.side)
      for (std::size_t k = 0; k < deep; ++k) {
        places.emplace_back(x, -grid.depth[k], z);
        group.push_back(k + 1 == deep                                         ? Group::kFloor
                        : k == 0 && std::hypot(x, z) <= p.radius * (1 + 1e-9) ? Group::kPunch
                                                                              : Group::kFree);
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

// Positive: the surface gives way. Means over the top's rings.
void read_top(const TetMesh& mesh, const Tissue& tissue, double punch, PressedBlock& out) {
  std::map<long, std::pair<double, double>> rings;  // by the radius: shares and how many
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

Result<std::vector<PressedBlock>> press_block(const BlockPress& press, const std::vector<double>& depths) {
  const TetMesh mesh = tets_of(grid_of(press), press);
  TissueMaterial material;
  material.young = press.young;
  material.poisson = press.poisson;
  material.strain = press.strain;
  TissueStep settle;
  if (press.strain == Strain::kCorotational) settle.iterations = 20, settle.tolerance = 1e-7;
  std::uint64_t begin = processor_ns();
  Tissue tissue(mesh, material, mesh.free_count);
  const auto solver = make_solver(SolverKind::kBlockCholesky, tissue.inner().size);
  solver->analyse(tissue.inner());
  std::vector<PressedBlock> all;
  double before = 0.0;
  for (const double depth : depths) {
    PressedBlock out;
    out.depth = depth;
    out.tets = mesh.tets.size();
    for (std::uint32_t i = mesh.free_count; i < mesh.pinned_begin(); ++i) tissue.position()[i].y -= depth - before;
    const TissueReport report = settle_tissue(tissue, *solver, dvec3(0), settle);
    if (!report.solved)
      return Error{"study", "the block of tetrahedra could not be solved; this is a defect of the study"};
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

}  // namespace pliant
