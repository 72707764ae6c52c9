// Co-rotational linear tetrahedra (methods.md 2.1): f_e = -R K_e (R^T x - x0), K' = R K_e R^T, implicit Euler
//   (M + T D + T^2 K') v = M v0 + T (f_el + f_ext),   D = alpha M + beta K'.
// Nodes in world frame. Node order as in TetMesh: free, handle, pinned.
#pragma once

#include <vector>

#include "components/math.h"
#include "components/tet_mesh.h"
#include "systems/tool/block_matrix.h"

namespace pliant {

struct FleshMaterial {
  double young = 5e3;       // [Pa]
  double poisson = 0.45;    // [1] < 0.5
  double density = 1000.0;  // [kg/m3]
  double alpha = 0.0;       // [1/s] Rayleigh damping, mass part
  double beta = 0.0;        // [s] stiffness part
};

class Flesh {
 public:
  // `moving`: leading nodes that have their own rows in the step (free ones; with spring attachment also the handle's).
  // Nodes from there on move as they are told (position() and velocity() are written by their owner).
  Flesh(const TetMesh& mesh, const FleshMaterial& material, std::uint32_t moving);

  // [m], [m/s], world, per node. Writer: whoever steps this flesh.
  std::vector<dvec3>& position() { return x_; }
  std::vector<dvec3>& velocity() { return v_; }
  const std::vector<dvec3>& position() const { return x_; }
  const std::vector<dvec3>& velocity() const { return v_; }
  const std::vector<double>& mass() const { return mass_; }  // [kg] lumped, per node
  std::uint32_t moving() const { return moving_; }

  // Rotations, forces and matrices at the current positions, for a step T [s] under gravity [m/s2].
  // inner: rows and columns of moving nodes; outer: A_ij for moving i and handle nodes j (those between moving and the
  // pinned), as a list; corner: A_ij among handle nodes; right: M v0 + T (f_el + f_ext) for all non-pinned nodes (3
  // each), where terms of K' and D on nodes outside `moving` stay on the left (they are unknowns of the handle).
  void assemble(double T, dvec3 gravity);
  const BlockMatrix& inner() const { return inner_; }
  BlockMatrix& inner() { return inner_; }  // its owner adds what ties nodes to a handle; the next assemble() starts anew
  struct Entry {
    std::uint32_t row, column;  // nodes
    Block value;
  };
  const std::vector<Entry>& outer() const { return outer_; }    // row < moving <= column < pinned_begin
  const std::vector<Entry>& corner() const { return corner_; }  // moving <= row, column < pinned_begin
  const Vector& right() const { return right_; }

  double elastic_energy() const;        // [J] at the current positions
  const Vector& elastic_force() const;  // [N] of the last assemble(), 3 per node, all nodes

 private:
  const TetMesh& mesh_;
  FleshMaterial material_;
  std::uint32_t moving_ = 0;
  std::vector<dvec3> x_, v_;
  std::vector<double> mass_;
  BlockMatrix inner_;
  std::vector<Entry> outer_, corner_;
  Vector right_, force_;
};

}  // namespace pliant
