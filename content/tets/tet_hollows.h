// Hollows inside tetrahedra.
#pragma once

#include <vector>

#include "components/tet_mesh.h"

namespace pliant {

// The closed inner surfaces, as TetCavity::wall.
std::vector<std::vector<uvec3>> hollows_of(const TetMesh& mesh);

}  // namespace pliant
