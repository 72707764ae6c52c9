// In how many separate pieces tissue and collision mesh are: tissue that falls into more than its collision mesh has
// lost a thin bridge.
#pragma once

#include <vector>

#include "components/mesh.h"
#include "components/tet_mesh.h"
#include "content/tets/tet_order.h"

namespace pliant {

// Joined by faces: a hinge of shared nodes alone holds nothing.
std::uint32_t count_parts(const TetMesh& mesh);
std::uint32_t count_parts(const Mesh& mesh);

// Which parts of a lattice are kept: the largest one; each that has at least kSmallPart of the volume; and each with a
// node that is pinned or on the handle, which stays where it is. Others are crumbs of what is thinner than a cell, and
// would fall out of the body or fly about in it: they are dropped, and the surface around them rides on what is
// nearest. Parts that only share nodes or an edge are not joined anew: what is large enough hangs on as by a hinge.
inline constexpr double kSmallPart = 0.01;  // [1] of the volume of all parts
// `group`: of each node; loses those of dropped parts. Writes TetReport's numbers; before embedding, nodes keep their
// order. Returns how many parts are left.
std::uint32_t drop_small_parts(TetMesh& mesh, std::vector<NodeGroup>& group);

}  // namespace pliant
