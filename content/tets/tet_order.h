// Which nodes of a soft body move by themselves, and in which order nodes and tetrahedra lie in memory.
#pragma once

#include <vector>

#include "components/tet_mesh.h"

namespace pliant {

enum class NodeGroup : std::uint8_t { kFree, kHandle, kPinned };

// Nodes in the order free, handle, pinned, each group along the Hilbert curve; tetrahedra along the curve of their
// centres. `group`: of each node, or empty: all are free. Embeddings follow their tetrahedra, and since corners keep
// their place in their tetrahedron, their weights stay.
void put_in_order(TetMesh& mesh, const std::vector<NodeGroup>& group);

}  // namespace pliant
