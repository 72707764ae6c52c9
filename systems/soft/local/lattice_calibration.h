// Compliance of a lattice of linear tetrahedra under a smeared load of radius R, relative to the half-space's: k along
// the normal, 1 / (2 E* R / k), and k_t along the surface. Measured on balls of stuffed lattice (lattice.h) with the
// half-space's displacements on their rim, at places and orientations of the surface that vary by 0.5 % (nu <= 0.45) to
// 1.7 % (0.495). Below 1 by locking and by what the cells do not resolve.
#pragma once

namespace pliant {

struct LatticeCompliance {
  double normal = 1.0, tangential = 1.0;  // [1] k, k_t
};

// `radius_over_cell`: R / c, from 1.5; smaller ones as 1.5. Piecewise linear in R / c, and in ln(1/2 - nu).
LatticeCompliance lattice_compliance(double poisson, double radius_over_cell);

// Of a lattice of hexahedra, at R / c = 1.5 and 2 and nu from 0 to 0.499: they do not lock. By place and orientation it
// varies by 3 %, along the surface by 6 %.
inline constexpr LatticeCompliance kComplianceOfCells{1.03, 1.055};

// [1] R / c that the split takes.
inline double smearing_cells(double poisson) {
  return poisson < 0.465 ? 1.5 : 2.0;
}

}  // namespace pliant
