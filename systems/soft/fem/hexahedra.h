// Co-rotational hexahedra of a lattice whose cells the surface cuts (LatticeCell). A cell counts by the tissue in it.
//
// With B_i the gradient of the trilinear shape function i, averaged over the tissue of volume V, in the world frame
// c_i = R B_i, and eps = sym(sum x_i c_i^T) - I, the mean strain acts as in a linear tetrahedron (tissue.h). Mean
// gradients do not lock where nu nears 1/2 (Flanagan and Belytschko 1981). The rest of the motion has no linear
// part: q_a = sum g_ai R^T x_i for a = yz, zx, xy, xyz in the cell's own coordinates,
//   g_ai = (h_ai - (sum_j h_aj x_j) . B_i) / 8,   h_a the product of the corner's coordinates.
// It bends and twists the cell. Its strain is assumed (Belytschko and Bindeman 1993): eps_d grows along e as in a
// plate, without the shear that comes with it and would lock; shear that grows along its own axis, of torsion, stays.
// Each counts by the variance of the tissue along that axis, so that the second moments of a section are those of the
// tissue.
#pragma once

#include <array>
#include <vector>

#include "components/math.h"
#include "components/tet_mesh.h"

namespace pliant {

struct Hexahedron {
  std::array<std::uint32_t, 8> node{};          // ascending
  double volume = 0.0;                          // [m3] of tissue, times the factor on stiffness
  double damping = 1.0, relaxation = 1.0;       // [1]
  std::array<dvec3, 8> gradient{};              // [1/m] B_i
  std::array<std::array<double, 8>, 4> rest{};  // [1] g_ai
  dvec3 over{0};                                // [1/m] 2 / the cell's widths
  dvec3 spread{0};                              // [1] LatticeCell::spread
  dquat q{1, 0, 0, 0};                          // R at the last evaluation
};

// Working data of one cell.
struct HexVisit {
  dmat3 R{1.0};
  std::array<dvec3, 8> c{};   // [1/m] R B_i
  std::array<dvec3, 8> f{};   // [N]
  std::array<dmat3, 36> K{};  // [N/m] of the pairs (0,0) (0,1) ... (0,7) (1,1) ... (7,7)
  double energy = 0.0;        // [J]
};

// Cells without tissue get no stiffness.
std::vector<Hexahedron> make_hexahedra(const TetMesh& mesh);

dquat rotation_of(const Hexahedron& hex, const std::vector<dvec3>& x);  // warm-started from hex.q
void turn_cell(const Hexahedron& hex, const dquat& q, HexVisit& visit);
// f and energy at x for visit.R; K.
void find_cell_forces(const Hexahedron& hex, const std::vector<dvec3>& x, double lambda, double mu, HexVisit& visit);
void find_cell_stiffness(const Hexahedron& hex, double lambda, double mu, HexVisit& visit);

// Relaxation (tissue_memory.h): the mean stress, xx, yy, zz, xy, xz, yz, and the forces on q_a, 3 each, in the cell's
// own axes. The history's forces are linear in the strain for the rotation of the cell, as those of the law.
inline constexpr std::size_t kCellStresses = 18;
void find_cell_stress(const Hexahedron& hex, const std::vector<dvec3>& x, double lambda, double mu,
                      const HexVisit& visit, double* stress);
// f and energy <- share of them, with those of the history.
void add_cell_history(const Hexahedron& hex, const std::vector<dvec3>& x, const double* history, double share,
                      HexVisit& visit);

// Pairs of a cell's corners, as the six tetrahedra that have them all between them.
std::array<Tet, 6> pairs_of(const std::array<std::uint32_t, 8>& node);

}  // namespace pliant
