// How well-shaped tetrahedra are. A regular one has dihedral angles of acos(1/3) = 70.5 degrees and a ratio of 1; where
// angles come near 0 or 180 degrees, matrices become badly conditioned and steps dear.
#pragma once

#include <span>

#include "components/tet_mesh.h"

namespace pliant {

// Of the elements; zeros where there are none.
TetQuality measure_quality(std::span<const dvec3> nodes, std::span<const Tet> tets);
// [m3] signed: positive where the corners stand as Tet wants them.
double tet_volume(std::span<const dvec3> nodes, const Tet& tet);
double total_volume(const TetMesh& mesh);

}  // namespace pliant
