// Points all over a surface, embedded in the tetrahedra below it: quadrature of loads smeared over it
// (systems/soft/local/smearing_surface.h).
#pragma once

#include "components/mesh.h"
#include "components/tet_mesh.h"

namespace pliant {

// [1] of a cell: at larger distances the force ripples and drags as a contact slides.
inline constexpr double kSampleOfCell = 0.25;

// Samples at most `spacing` [m] apart in each triangle, at the centres of equal parts. Tetrahedra in Hilbert order.
std::vector<SurfaceSample> sample_surface(const Mesh& surface, double spacing, const TetMesh& tets);
// The same at a quarter of the body's cell (the finest, of a lattice with a focus; the mean longest edge, of a file's).
std::vector<SurfaceSample> sample_surface(const Mesh& surface, const TetMesh& tets);

}  // namespace pliant
