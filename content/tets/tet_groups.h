// Assigns the nodes of a soft body that are on the rigid handle or pinned.
#pragma once

#include "components/soft_body.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/tet_order.h"
#include "runtime/result.h"

namespace pliant {

// "(0, 0, 0) to (1, 1, 1) m"
std::string text_of(const Box& box);

// A node is in a group if the group's box contains it. Without a box, the paint of the nearest surface vertex decides,
// from 0.5 up (BuiltMesh::handle and pinned). Handle and rigid parts have precedence over pins. `handle`: null if the
// body has none. Errors, one sentence each: a handle without box or paint, a box or paint that contains no node, a node
// in two rigid parts, no free node left.
Result<std::vector<NodeGroup>> group_nodes(const std::vector<dvec3>& nodes, const BuiltMesh& surface,
                                           const SoftBody& body, const Handle6* handle);

}  // namespace pliant
