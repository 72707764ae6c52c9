// Attachment of tissue to its handle (methods.md 2.2), either way as rows of one coupled system A [v; w] = b:
//   slave   v_i = G_i w: the handle's nodes have no rows;
//           A_th = A_ij G_j, A_hh = G_i^T A_ij G_j, b_h = G_i^T b_i.
//   spring  the handle's nodes are tissue, tied to their place on the handle by springs k, b,
//           s = T b + T^2 k, with stretch e_i:
//           A_ii += s I, A_th = -s G_i, A_hh += s G_i^T G_i, b_i -= T k e_i, b_h += T k G_i^T e_i.
//           G_i is taken at the node, not at its place on the handle: springs and dampers then exert no torque.
// In both, the nodes' mass belongs to the handle. With springs it is subtracted from the nodes, so that both describe
// the same tool and the second tends to the first as the springs stiffen. Compared on a bar with the first quarter
// rigid, T = 1/60 s:
//   condition of A, 324 tetrahedra:  slave 4e3;  spring of 1, 10, 100, 1000: 3e3, 2e4, 2e5, 2e6
//   largest difference of node positions at rest, of the bar's length:    3 %, 0.5 %, 0.06 %, 0.006 %
//   step, 2,100 tetrahedra:          slave 2.2 ms;  spring 3.1 ms (the handle's nodes have rows)
// Slaved nodes are exact, cheaper and better conditioned; springs are those of P2.
#pragma once

#include <vector>

#include "components/soft_body.h"
#include "systems/soft/body/handle.h"
#include "systems/soft/body/rigid_parts.h"
#include "systems/soft/body/schur.h"
#include "systems/soft/fem/tissue.h"

namespace pliant {

// Stiffness of a node's spring, in units of young * (size of the tissue around it): usual 100. More: a stiffer
// attachment and a proportionally larger condition number of A; less: the handle slips inside its tissue.
inline constexpr double kTieStiffness = 100.0;

class HandleTie {
 public:
  // The handle's nodes in `tissue` are [first, first + handle.node_count()). `parts`: null without; else they outlive
  // it.
  HandleTie(Attachment attachment, const TissueMaterial& material, const Tissue& tissue, std::uint32_t first,
            const RigidParts* parts = nullptr);

  void set_material(const TissueMaterial& material) { material_ = material; }
  // After tissue.assemble(T, gravity) and parts.assemble(): adds the handle to tissue.inner(), and fills border(),
  // corner(), right().
  void assemble(Tissue& tissue, const RigidHandle& handle, double T, dvec3 gravity);
  // Adds further terms of the handle: a diagonal of A_hh and a part of b_h.
  void add_to_handle(const Vector6& diagonal, const Vector6& right) {
    corner_.diagonal() += diagonal;
    right_.tail<6>() += right;
  }

  const std::vector<HandleRow>& border() const { return border_; }  // A_th
  const Matrix6& corner() const { return corner_; }                 // A_hh
  const Vector& right() const { return right_; }                    // b: tissue's and parts' rows, then the handle's

  double stiffness = kTieStiffness;  // [1]

 private:
  void slave(const Tissue& tissue, const RigidHandle& handle);
  Grip& border_at(std::uint32_t block_row);
  void spring(Tissue& tissue, const RigidHandle& handle, double T, dvec3 gravity);

  Attachment attachment_;
  TissueMaterial material_;
  std::uint32_t first_ = 0;
  const RigidParts* parts_ = nullptr;
  std::vector<std::uint32_t> row_of_node_;  // slave: index into border_ of a block row, or 0xffffffff
  std::vector<HandleRow> border_;
  Matrix6 corner_ = Matrix6::Zero();
  Vector right_;
};

}  // namespace pliant
