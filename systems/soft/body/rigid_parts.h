// Rigid parts of a soft body besides its handle: bones in tissue (methods.md 2.17). Their nodes are slaved to them
// (handle_tie.h), v_i = G_i w; each part has six unknowns, its twist w (handle.h). Nothing else moves them than tissue,
// contacts and joints. With tissue's rows t and the parts' rows p:
//   A_tp = A_ij G_j,   A_pp = G_i^T A_ij G_j (two parts may share an element),   b_p = G_i^T b_i.
// Elimination of tissue first, then of the parts, then of the handle (schur.h) is the Schur complement of 6 n rows of n
// rigid parts, block by block. Tissue's solver stays a black box.
#pragma once

#include <Eigen/Cholesky>
#include <memory>
#include <vector>

#include "systems/soft/body/handle.h"
#include "systems/soft/fem/tissue.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {

class RigidParts {
 public:
  // `body`: the rest box of the whole body [m], `placement`: object to world, both as of RigidHandle.
  RigidParts(const TetMesh& tets, const Tissue& tissue, dvec3 body, const Pose& placement);

  std::size_t count() const { return parts_.size(); }
  Eigen::Index rows() const { return 6 * static_cast<Eigen::Index>(parts_.size()); }
  RigidHandle& operator[](std::size_t part) { return parts_[part]; }
  const RigidHandle& operator[](std::size_t part) const { return parts_[part]; }
  bool has(std::uint32_t node) const { return node >= begin_ && node < end_; }
  std::size_t of(std::uint32_t node) const { return part_of_[node - begin_]; }
  dvec3 arm(std::uint32_t node) const { return parts_[of(node)].arm(node - first_[of(node)]); }  // [m] world axes, now

  // After tissue.assemble(). `fixed`: they keep their velocity of zero, whatever pulls.
  void assemble(const Tissue& tissue, bool fixed);
  struct Entry {
    std::uint32_t node, part;
    Grip value;
  };
  const std::vector<Entry>& border() const { return border_; }  // A_tp; a node and part may have several
  const Eigen::MatrixXd& corner() const { return corner_; }     // A_pp
  const Vector& right() const { return right_; }                // b_p

  Vector velocity() const;  // w of all parts
  void set_velocity(const Vector& w);

 private:
  std::uint32_t begin_ = 0, end_ = 0;  // their nodes
  std::vector<RigidHandle> parts_;
  std::vector<std::uint32_t> first_;  // node of each
  std::vector<std::uint32_t> part_of_;
  std::vector<Entry> border_;
  Eigen::MatrixXd corner_;
  Vector right_;
};

// Tissue and rigid parts as one black box. Right-hand sides: tissue's rows, then six of each part.
class PartsSolver final : public LinearSolver {
 public:
  // `parts`: read by every factorise(); they outlive it.
  PartsSolver(std::unique_ptr<LinearSolver> tissue, const RigidParts& parts)
      : tissue_(std::move(tissue)), parts_(parts) {}

  std::string_view name() const override { return tissue_->name(); }
  void analyse(const BlockMatrix& a) override;
  void place(const std::vector<dvec3>& nodes) override { tissue_->place(nodes); }
  [[nodiscard]] bool factorise(const BlockMatrix& a) override;
  void solve(const Vector& b, Vector& x) const override;
  void solve_many(Eigen::Ref<Rows> columns) const override;
  void solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const override;

 private:
  // p = S^-1 (b_p - A_pt y)
  Eigen::MatrixXd move_parts(const Eigen::Ref<const Rows>& y, Eigen::MatrixXd p) const;

  std::unique_ptr<LinearSolver> tissue_;
  const RigidParts& parts_;
  Eigen::Index rows_ = 0;  // of tissue
  Rows z_;                 // A_tt^-1 A_tp
  Eigen::LLT<Eigen::MatrixXd> schur_;
};

}  // namespace pliant
