// One isosurface stuffing of one lattice: nodes and tetrahedra, in the order of the lattice.
#pragma once

#include <stop_token>
#include <vector>

#include "components/tet_mesh.h"
#include "content/tets/fill_region.h"
#include "content/tets/lattice_grid.h"
#include "runtime/long_work.h"
#include "runtime/result.h"

namespace pliant {

struct Stuffing {
  std::vector<dvec3> nodes;  // [m]
  std::vector<Tet> tets;     // positive volume
  bool beyond = false;       // there are more than were allowed: given up
};

// Empty where no lattice point lies in the region. Error: whoever waits wants no more of it.
Result<Stuffing> stuff(const Mesh& surface, const FillRegion& region, const LatticeGrid& grid, std::size_t most,
                       LongWork& progress, const std::stop_token& stop = {});

}  // namespace pliant
