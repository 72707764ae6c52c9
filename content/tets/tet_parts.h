// In how many separate pieces tissue and collision mesh are: tissue that falls into more than its collision mesh has
// lost a thin bridge.
#pragma once

#include "components/mesh.h"
#include "components/tet_mesh.h"

namespace pliant {

// Joined by faces: a hinge of shared nodes alone holds nothing.
std::uint32_t count_parts(const TetMesh& mesh);
std::uint32_t count_parts(const Mesh& mesh);

}  // namespace pliant
