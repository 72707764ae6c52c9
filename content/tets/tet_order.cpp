#include "content/tets/tet_order.h"

#include <algorithm>

#include "content/mesh/hilbert.h"
#include "runtime/assert.h"

namespace pliant {
namespace {

// out[i] = values[order[i]]; an empty list stays empty.
template <class T>
void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  if (values.empty()) return;
  std::vector<T> out;
  out.reserve(order.size());
  for (const std::uint32_t from : order) out.push_back(values[from]);
  values = std::move(out);
}

}  // namespace

void put_in_order(TetMesh& mesh, const std::vector<NodeGroup>& group) {
  ASSERT(group.empty() || group.size() == mesh.nodes.size());
  std::vector<vec3> points(mesh.nodes.begin(), mesh.nodes.end());
  std::vector<std::uint32_t> order = hilbert_order(points);
  if (!group.empty())
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return group[a] < group[b]; });
  const auto count = [&](NodeGroup which) {
    return static_cast<std::uint32_t>(std::count(group.begin(), group.end(), which));
  };
  mesh.handle_count = count(NodeGroup::kHandle);
  mesh.rigid_counts.clear();
  for (std::size_t part = 0; const std::uint32_t nodes = count(rigid_group(part)); ++part)
    mesh.rigid_counts.push_back(nodes);
  mesh.free_count = count(NodeGroup::kFree);
  if (group.empty()) mesh.free_count = mesh.node_count();

  std::vector<dvec3> nodes(order.size());
  std::vector<std::uint32_t> moved(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    nodes[i] = mesh.nodes[order[i]];
    moved[order[i]] = i;
  }
  mesh.nodes = std::move(nodes);

  for (Tet& tet : mesh.tets)
    for (std::uint32_t& corner : tet) corner = moved[corner];
  for (LatticeCell& cell : mesh.cells)
    for (std::uint32_t& corner : cell.nodes) corner = moved[corner];
  permute(mesh.volume, order);

  // The tetrahedra of a cell stay together.
  const std::size_t each = mesh.cells.empty() ? 1 : kTetsOfCell;
  ASSERT(mesh.tets.size() == each * (mesh.cells.empty() ? mesh.tets.size() : mesh.cells.size()));
  std::vector<vec3> centres;
  centres.reserve(mesh.tets.size() / each);
  for (std::size_t t = 0; t < mesh.tets.size(); t += each) {
    dvec3 sum(0);
    for (std::size_t k = 0; k < each; ++k)
      for (const std::uint32_t corner : mesh.tets[t + k]) sum += mesh.nodes[corner];
    centres.push_back(vec3(sum / static_cast<double>(4 * each)));
  }
  const std::vector<std::uint32_t> cell_order = hilbert_order(centres);
  std::vector<std::uint32_t> tet_order, tet_moved(mesh.tets.size());
  for (const std::uint32_t cell : cell_order)
    for (std::size_t k = 0; k < each; ++k) tet_order.push_back(static_cast<std::uint32_t>(each * cell + k));
  for (std::uint32_t i = 0; i < tet_order.size(); ++i) tet_moved[tet_order[i]] = i;
  permute(mesh.tets, tet_order);
  permute(mesh.cells, cell_order);
  permute(mesh.factors, cell_order);
  permute(mesh.group, tet_order);
  for (Embedding& e : mesh.embedding) e.tet = tet_moved[e.tet];
}

}  // namespace pliant
