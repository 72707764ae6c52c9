// The tetrahedra or hexahedra of a soft body from its surface. Of the first:
//
// Isosurface stuffing (Labelle & Shewchuk, "Isosurface stuffing: fast tetrahedral meshes with good dihedral angles",
// 2007) on a body-centred cubic lattice. Inner lattice tetrahedra are kept; those that the surface cuts are warped and
// clipped to it. The alternative was an embedded lattice of whole cells. Its elements are better (60 and 90 degrees),
// but its stepped boundary adds half a cell of tissue all around; with four cells across a finger this doubles the
// mass. Deterministic, and independent of the number of threads.
#pragma once

#include <stop_token>

#include "components/mesh.h"
#include "components/tet_mesh.h"
#include "content/tets/lattice_grid.h"
#include "pliant/parameters.h"
#include "runtime/result.h"

namespace pliant {

inline constexpr std::size_t kUsualTets = 2'000;  // target if the level specifies no cell
// The upper limit, however thin or bent the surface is: a step of some 30 ms (step_cost.h).
inline constexpr std::size_t kMostUsualTets = 4 * kUsualTets;
// Most lattice nodes per attempt in the search for the usual cell: 0.1 s. An object that fills too little of its box
// for this gets fewer tetrahedra.
inline constexpr double kMostUsualNodes = 100'000;

struct LatticeOptions {
  double cell = 0.0;         // [m] 0: chosen to give about kUsualTets
  Fill fill = Fill::kSolid;  // with `thickness` [m], as in SoftBodyParameters
  double thickness = 0.0;
  std::stop_token stop;               // cancels the filling with an error
  std::optional<LatticeFocus> focus;  // where the lattice is finer: `cell` is the size in its middle
  Elements elements = Elements::kTetrahedra;
};

// Fills a surface (small holes do not matter) with tetrahedra, without embedding: a wall's cavity by `fill`, an open
// sheet with `thickness`. All nodes are free, in Hilbert order; small parts are kept (tet_parts.h). Fills TetReport
// except for the parts. Errors: a cell or thickness that is not a finite length, nothing enclosed, more than
// limits::kTets. Progress messages go to stderr after a second.
Result<TetMesh> fill_surface(const Mesh& surface, const LatticeOptions& options);

// The same for a solid, with every vertex of the surface embedded.
Result<TetMesh> make_lattice(const Mesh& surface, double cell = 0.0);

}  // namespace pliant
