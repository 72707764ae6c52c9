// The memory order of a soft body's nodes and tetrahedra.
#pragma once

#include <vector>

#include "components/tet_mesh.h"

namespace pliant {

enum class NodeGroup : std::uint8_t { kFree, kHandle, kRigid, kPinned = 0xff };
// Of further rigid part number `part`.
inline NodeGroup rigid_group(std::size_t part) {
  return static_cast<NodeGroup>(static_cast<std::size_t>(NodeGroup::kRigid) + part);
}

// Nodes in the order free, handle, each further rigid part, pinned, each group along the Hilbert curve; tetrahedra
// along the curve of their centres. `group`: per node; empty: all are free. Embeddings follow their tetrahedra. Corners
// keep their position within a tetrahedron, so weights stay valid.
void put_in_order(TetMesh& mesh, const std::vector<NodeGroup>& group);

}  // namespace pliant
