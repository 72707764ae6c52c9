// Errors to expect of a lattice: estimates from measurements on bars and blocks.
#pragma once

#include "components/mesh.h"
#include "components/tet_mesh.h"

namespace pliant {

struct LatticeErrors {
  double across = 0.0;                  // [1] cells across the body, at the median; 0: no lattice
  double section = 0.0;                 // [1] of the elements' volume, against the tissue's: below 0 is missing
  double bending = 0.0, torsion = 0.0;  // [1] of the stiffness, above 0 too stiff
  double contact_radius = 0.0;          // [m] a fingertip of kContactOfThickness of the median thickness
  double contact = 0.0;  // [1] of the stiffness against a flat contact of that radius, `contact` `lattice`
};
inline constexpr double kContactOfThickness = 0.25;  // [1]

// Bars of square section, L = 4 H, on fitted tetrahedra: 0.85 / n^2 too stiff in bending and 2.1 / n^2 in torsion at n
// cells across (nu 0.3), 1.4 times that at 0.49; on hexahedra 0.2 / n^2 and 0.3 / n^2. Contacts of radius a on cells c:
// 1.06 at a = c, 0.46 at a = 2 c, 0.23 at a = 4 c.
LatticeErrors expected_errors(const TetMesh& mesh, const Mesh& surface, double poisson);

}  // namespace pliant
