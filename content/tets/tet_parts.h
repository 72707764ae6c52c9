// Connected parts of tissue and collision mesh. Tissue with more parts than its collision mesh has lost a thin bridge.
#pragma once

#include <vector>

#include "components/mesh.h"
#include "components/tet_mesh.h"
#include "content/tets/tet_order.h"

namespace pliant {

// Connected by faces: shared nodes alone are a hinge.
std::uint32_t count_parts(const TetMesh& mesh);
std::uint32_t count_parts(const Mesh& mesh);

// Keeps the largest part of a lattice, each with at least kSmallPart of the volume, and each with a node that is pinned
// or on the handle. Other parts come from places thinner than a cell and would fall or fly about; they are dropped. The
// surface around them is embedded in the nearest tissue. Parts that share only nodes or an edge are not connected;
// large ones stay hinged.
inline constexpr double kSmallPart = 0.01;  // [1] of the volume of all parts
// `group`: per node; entries of dropped parts are removed. Sets TetReport's numbers. Call before embedding; nodes keep
// their order. Returns the number of parts left.
std::uint32_t drop_small_parts(TetMesh& mesh, std::vector<NodeGroup>& group);

}  // namespace pliant
