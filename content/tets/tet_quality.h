// Shape quality of tetrahedra. A regular one has dihedral angles of acos(1/3) = 70.5 degrees and a ratio of 1. Angles
// near 0 or 180 degrees make matrices badly conditioned and steps slow.
#pragma once

#include <span>

#include "components/tet_mesh.h"

namespace pliant {

// Over all elements; zeros if there are none.
TetQuality measure_quality(std::span<const dvec3> nodes, std::span<const Tet> tets);
// [m3] signed: positive for the corner order that Tet requires.
double tet_volume(std::span<const dvec3> nodes, const Tet& tet);
double total_volume(const TetMesh& mesh);
// [m3] Of tissue: what the body's mass is of.
double tissue_volume(const TetMesh& mesh);

}  // namespace pliant
