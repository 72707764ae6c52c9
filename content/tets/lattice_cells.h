// A lattice of whole hexahedra over a surface (LatticeCell). Its cells are those that hold tissue, each with its share
// and the moments of it: nothing is cut, so a section has the area and second moments of the surface's, and no element
// is thin. The lattice spans the box of the region with a whole number of cells along each axis, so that a box is met
// exactly. A gap narrower than a cell is closed.
#pragma once

#include <stop_token>

#include "components/tet_mesh.h"
#include "content/tets/fill_region.h"
#include "runtime/long_work.h"
#include "runtime/result.h"

namespace pliant {

// Fills `nodes`, `tets`, `cells` and `volume` of a mesh, in the order of the lattice. cell [m] 0: as many cells as have
// the usual number of tetrahedra. Returns the cell; 0: nothing is enclosed. Error: too many, or cancelled by `stop`.
Result<double> fill_cells(const Mesh& surface, const FillRegion& region, double cell, LongWork& progress,
                          const std::stop_token& stop, TetMesh& mesh);

}  // namespace pliant
