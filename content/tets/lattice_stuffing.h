// Isosurface stuffing of one lattice: nodes and tetrahedra, in the order of the lattice.
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
  bool beyond = false;       // the allowed number was exceeded: cancelled
};

// Empty if no lattice point lies in the region. Error: cancelled by `stop`.
Result<Stuffing> stuff(const Mesh& surface, const FillRegion& region, const LatticeGrid& grid, std::size_t most,
                       LongWork& progress, const std::stop_token& stop = {});

}  // namespace pliant
