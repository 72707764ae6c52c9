#include "content/tets/tet_order.h"

#include <algorithm>

#include "content/mesh/hilbert.h"
#include "runtime/assert.h"

namespace pliant {

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
  mesh.free_count = mesh.node_count() - mesh.handle_count - count(NodeGroup::kPinned);

  std::vector<dvec3> nodes(order.size());
  std::vector<std::uint32_t> moved(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    nodes[i] = mesh.nodes[order[i]];
    moved[order[i]] = i;
  }
  mesh.nodes = std::move(nodes);

  std::vector<vec3> centres;
  centres.reserve(mesh.tets.size());
  for (Tet& tet : mesh.tets) {
    dvec3 sum(0);
    for (std::uint32_t& corner : tet) sum += mesh.nodes[corner = moved[corner]];
    centres.push_back(vec3(0.25 * sum));
  }
  const std::vector<std::uint32_t> tet_order = hilbert_order(centres);
  std::vector<Tet> tets(tet_order.size());
  std::vector<std::uint32_t> tet_moved(tet_order.size());
  for (std::uint32_t i = 0; i < tet_order.size(); ++i) {
    tets[i] = mesh.tets[tet_order[i]];
    tet_moved[tet_order[i]] = i;
  }
  mesh.tets = std::move(tets);
  for (Embedding& e : mesh.embedding) e.tet = tet_moved[e.tet];
}

}  // namespace pliant
