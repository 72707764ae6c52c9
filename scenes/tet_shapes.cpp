#include "scenes/tet_shapes.h"

#include <algorithm>
#include <utility>

namespace pliant::tets {
namespace {

double six_volumes(const std::vector<dvec3>& x, const Tet& t) {
  return dot(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), x[t[3]] - x[t[0]]);
}

}  // namespace

TetMesh grid(const std::vector<double>& xs, const std::vector<double>& ys, const std::vector<double>& zs) {
  TetMesh mesh;
  mesh.name = "grid";
  for (const double x : xs)
    for (const double y : ys)
      for (const double z : zs) mesh.nodes.emplace_back(x, y, z);
  mesh.free_count = mesh.node_count();
  const auto node = [&](std::array<std::size_t, 3> at) {
    return static_cast<std::uint32_t>((at[0] * ys.size() + at[1]) * zs.size() + at[2]);
  };
  // Kuhn's subdivision: from the cell's first corner to its last along the three axes in all six orders; odd cells
  // start at their far side.
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (std::size_t i = 0; i + 1 < xs.size(); ++i)
    for (std::size_t j = 0; j + 1 < ys.size(); ++j)
      for (std::size_t k = 0; k + 1 < zs.size(); ++k)
        for (const auto& order : kOrders) {
          const std::array<std::size_t, 3> cell{i, j, k};
          std::array<std::size_t, 3> at;
          for (std::size_t d = 0; d < 3; ++d) at[d] = cell[d] + cell[d] % 2;
          Tet tet{node(at), 0, 0, 0};
          for (std::size_t step = 0; step < 3; ++step) {
            const std::size_t d = static_cast<std::size_t>(order[step]);
            at[d] = cell[d] + (1 - cell[d] % 2);
            tet[step + 1] = node(at);
          }
          if (six_volumes(mesh.nodes, tet) < 0) std::swap(tet[2], tet[3]);
          mesh.tets.push_back(tet);
        }
  return mesh;
}

std::vector<double> even(int count, double from, double to) {
  std::vector<double> at;
  for (int i = 0; i <= count; ++i) at.push_back(from + (to - from) * i / count);
  return at;
}

TetMesh box(int nx, int ny, int nz, dvec3 min, dvec3 max) {
  return grid(even(nx, min.x, max.x), even(ny, min.y, max.y), even(nz, min.z, max.z));
}

void hold(TetMesh& mesh, const std::function<bool(dvec3)>& pinned, const std::function<bool(dvec3)>& handle) {
  const auto group = [&](std::uint32_t n) { return pinned(mesh.nodes[n]) ? 2 : handle(mesh.nodes[n]) ? 1 : 0; };
  std::vector<std::uint32_t> order(mesh.nodes.size()), new_name(mesh.nodes.size());
  for (std::uint32_t n = 0; n < order.size(); ++n) order[n] = n;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return group(a) < group(b); });
  std::vector<dvec3> nodes;
  std::array<std::uint32_t, 3> counts{};
  for (const std::uint32_t n : order) {
    new_name[n] = static_cast<std::uint32_t>(nodes.size());
    ++counts[static_cast<std::size_t>(group(n))];
    nodes.push_back(mesh.nodes[n]);
  }
  mesh.nodes = std::move(nodes);
  for (Tet& tet : mesh.tets)
    for (std::uint32_t& n : tet) n = new_name[n];
  for (LatticeCell& cell : mesh.cells)
    for (std::uint32_t& n : cell.nodes) n = new_name[n];
  const std::vector<double> volume = mesh.volume;
  for (std::size_t n = 0; n < volume.size(); ++n) mesh.volume[new_name[n]] = volume[n];
  mesh.free_count = counts[0];
  mesh.handle_count = counts[1];
}

dvec3 scatter(std::uint32_t number) {
  dvec3 out;
  for (int d = 0; d < 3; ++d) {
    std::uint32_t h = (3 * number + static_cast<std::uint32_t>(d) + 1) * 2654435761u;
    h ^= h >> 15, h *= 2246822519u, h ^= h >> 13, h *= 3266489917u, h ^= h >> 16;
    out[d] = h / 2147483648.0 - 1.0;
  }
  return out;
}

double volume(const TetMesh& mesh, const std::vector<dvec3>& x) {
  double sum = 0.0;
  for (const Tet& tet : mesh.tets) sum += six_volumes(x, tet) / 6;
  return sum;
}

}  // namespace pliant::tets
