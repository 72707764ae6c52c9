// Hollows in tissue with a pressure p = pressure + bulk (1 - V / V_0) (TetCavity). With V the volume that the wall
// encloses, and g = grad V, their energy bulk (V - V_0)^2 / 2 V_0 - pressure V gives
//   f = p g,   K = (bulk / V_0) g g^T - p grad g.
// The first part of K is one column in a step's matrix (low_rank_solver.h); the second, which is indefinite, is left
// out, as the stresses' own is from co-rotational tissue: it changes no equilibrium.
#pragma once

#include <vector>

#include "components/tet_mesh.h"
#include "systems/soft/linear/block_matrix.h"

namespace pliant {

class Cavities {
 public:
  // Volumes at rest are of the mesh's nodes.
  explicit Cavities(const TetMesh& mesh);

  bool empty() const { return cavities_.empty(); }
  std::size_t count() const { return cavities_.size(); }
  double volume(std::size_t cavity, const std::vector<dvec3>& x) const;    // [m3]
  double rest_volume(std::size_t cavity) const { return rest_[cavity]; }   // [m3]
  double pressure(std::size_t cavity, const std::vector<dvec3>& x) const;  // [Pa]
  double energy(const std::vector<dvec3>& x) const;                        // [J]
  void add_forces(const std::vector<dvec3>& x, Vector& force) const;       // [N] 3 per node
  // For a step of T: U with U U^T = T^2 sum (bulk / V_0) g g^T, of the first `moving` nodes; to the right-hand side of
  // its nodes T f, U U^T (x - begin) / T, and minus U U^T v of the nodes that are not `moving`.
  void assemble(double T, std::uint32_t moving, const std::vector<dvec3>& x, const std::vector<dvec3>& v,
                const std::vector<dvec3>* begin, Rows& columns, Vector& right) const;

 private:
  Vector gradient(std::size_t cavity, const std::vector<dvec3>& x) const;

  const std::vector<TetCavity>& cavities_;
  std::vector<double> rest_;  // [m3] V_0
};

}  // namespace pliant
