// The tetrahedra of a soft body from its surface.
//
// Isosurface stuffing (Labelle & Shewchuk, "Isosurface stuffing: fast tetrahedral meshes with good dihedral angles",
// 2007) on a body-centred cubic lattice: lattice tetrahedra inside stay as they are, those that the surface cuts are
// warped and clipped to it. It won over an embedded lattice of whole cells, whose elements are better still (60 and 90
// degrees) but whose steps on the surface put half a cell too much tissue all around: at four cells across a finger
// that doubles its mass. Deterministic, and independent of the number of threads.
#pragma once

#include <stop_token>

#include "components/mesh.h"
#include "components/tet_mesh.h"
#include "content/tets/lattice_grid.h"
#include "pliant/parameters.h"
#include "runtime/result.h"

namespace pliant {

inline constexpr std::size_t kUsualTets = 2'000;  // aimed at where the level names no cell
// ... and never more than this, however thin or bent the surface is: a step of some 30 ms (step_cost.h).
inline constexpr std::size_t kMostUsualTets = 4 * kUsualTets;
// Lattice nodes that the search for the usual cell looks at in one try: 0.1 s. Whatever fills so little
// of its box that it would need more gets fewer tetrahedra.
inline constexpr double kMostUsualNodes = 100'000;

struct LatticeWish {
  double cell = 0.0;         // [m] 0: the one that makes about kUsualTets
  Fill fill = Fill::kSolid;  // ... and `thickness` [m]: as SoftBodyParameters
  double thickness = 0.0;
  std::stop_token stop;               // a filling that is no longer wanted ends with an error
  std::optional<LatticeFocus> focus;  // where it is finer: `cell` is the one in its middle
};

// Fills a surface (small holes do not matter) with tetrahedra, without embedding it in them: a wall's cavity as `fill`
// says, an open sheet with `thickness`. All nodes are free, in Hilbert order; parts are as they come (tet_parts.h).
// TetMesh::report says what it found but what concerns parts. Errors: a cell or thickness that is not a finite length,
// nothing enclosed, more than limits::kTets. Progress over a second goes to stderr.
Result<TetMesh> fill_surface(const Mesh& surface, const LatticeWish& wish);

// ... of a solid, with every vertex of the surface embedded.
Result<TetMesh> make_lattice(const Mesh& surface, double cell = 0.0);

}  // namespace pliant
