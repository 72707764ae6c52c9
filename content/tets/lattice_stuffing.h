// One isosurface stuffing at one cell size: nodes and tetrahedra, in the order of the lattice.
#pragma once

#include <vector>

#include "components/tet_mesh.h"
#include "content/level/progress.h"
#include "content/tets/lattice_inside.h"
#include "runtime/result.h"

namespace pliant {

struct Stuffing {
  std::vector<dvec3> nodes;  // [m]
  std::vector<Tet> tets;     // positive volume
};

// Empty where no lattice point lies inside. Error: more than `most` tetrahedra.
Result<Stuffing> stuff(const Mesh& surface, const Inside& inside, double cell, std::size_t most, Progress& progress);

}  // namespace pliant
