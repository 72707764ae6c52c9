// The tetrahedra of a soft body from its surface.
//
// Isosurface stuffing (Labelle & Shewchuk, "Isosurface stuffing: fast tetrahedral meshes with good dihedral angles",
// 2007) on a body-centred cubic lattice: lattice tetrahedra inside stay as they are, those that the surface cuts are
// warped and clipped to it. It won over an embedded lattice of whole cells, whose elements are better still (60 and 90
// degrees) but whose steps on the surface put half a cell too much tissue all around: at four cells across a finger
// that doubles its mass. Deterministic, and independent of the number of threads.
#pragma once

#include "components/mesh.h"
#include "components/tet_mesh.h"
#include "runtime/result.h"

namespace pliant {

inline constexpr std::size_t kUsualTets = 2'000;  // aimed at where the level names no cell

// Fills what the surface encloses (small holes do not matter) with tetrahedra of about `cell` [m]; 0: about kUsualTets
// of them. Every vertex of the surface is embedded. All nodes are free, in Hilbert order. Errors: a cell that is not
// positive and finite, nothing enclosed, more than limits::kTets. Progress over a second goes to stderr.
Result<TetMesh> make_lattice(const Mesh& surface, double cell = 0.0);

}  // namespace pliant
