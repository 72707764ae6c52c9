// Which nodes of a soft body are held: by the rigid handle, or by the world.
#pragma once

#include "components/soft_body.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/tet_order.h"
#include "runtime/result.h"

namespace pliant {

// "(0, 0, 0) to (1, 1, 1) m"
std::string text_of(const Box& box);

// A node belongs to a box that it lies in; without a box, to the paint of the surface vertex nearest to it, from 0.5 up
// (BuiltMesh::handle and pinned). What handle and pins both claim is the handle's. `handle`: null where the body has
// none. Errors, one sentence each: a handle without box or paint, a box or paint that holds no node, nothing left free.
Result<std::vector<NodeGroup>> group_nodes(const std::vector<dvec3>& nodes, const BuiltMesh& surface,
                                           const SoftBody& body, const Handle6* handle);

}  // namespace pliant
