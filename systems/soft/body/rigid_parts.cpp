#include "systems/soft/body/rigid_parts.h"

#include "runtime/assert.h"

namespace pliant {
namespace {

constexpr double kFixedMass = 1e8;  // [kg], [kg m2] added to parts that keep their place: far above any body's

}  // namespace

RigidParts::RigidParts(const TetMesh& tets, const Tissue& tissue, dvec3 body, const Pose& placement)
    : begin_(tets.rigid_begin()), end_(tets.pinned_begin()) {
  std::uint32_t first = begin_;
  for (const std::uint32_t count : tets.rigid_counts) {
    part_of_.insert(part_of_.end(), count, static_cast<std::uint32_t>(parts_.size()));
    first_.push_back(first);
    parts_.emplace_back(std::span(tets.nodes).subspan(first, count), std::span(tissue.mass()).subspan(first, count),
                        body, placement);
    first += count;
  }
  ASSERT(tissue.moving() <= begin_);
}

void RigidParts::assemble(const Tissue& tissue, bool fixed) {
  border_.clear();
  corner_.setZero(rows(), rows());
  right_.setZero(rows());
  for (const Tissue::Entry& entry : tissue.outer())
    if (has(entry.column))
      border_.push_back(
          {entry.row, static_cast<std::uint32_t>(of(entry.column)), entry.value * grip_matrix(arm(entry.column))});
  for (const Tissue::Entry& entry : tissue.corner())
    if (has(entry.row) && has(entry.column))
      corner_.block<6, 6>(6 * static_cast<Eigen::Index>(of(entry.row)), 6 * static_cast<Eigen::Index>(of(entry.column)))
          .noalias() += grip_matrix(arm(entry.row)).transpose() * (entry.value * grip_matrix(arm(entry.column))).eval();
  for (std::uint32_t node = begin_; node < end_; ++node)
    right_.segment<6>(6 * static_cast<Eigen::Index>(of(node))) +=
        grip_matrix(arm(node)).transpose() * tissue.right().segment<3>(3 * static_cast<Eigen::Index>(node));
  for (std::size_t part = 0; part < parts_.size(); ++part) {
    const auto row = 6 * static_cast<Eigen::Index>(part);
    const Matrix6 lent = parts_[part].lent_mass();
    corner_.block<6, 6>(row, row) += lent;
    right_.segment<6>(row) += lent * parts_[part].motion().velocity;
  }
  if (fixed) corner_.diagonal().array() += kFixedMass;
}

Vector RigidParts::velocity() const {
  Vector out(rows());
  for (std::size_t part = 0; part < parts_.size(); ++part)
    out.segment<6>(6 * static_cast<Eigen::Index>(part)) = parts_[part].motion().velocity;
  return out;
}

void RigidParts::set_velocity(const Vector& w) {
  for (std::size_t part = 0; part < parts_.size(); ++part)
    parts_[part].set_velocity(w.segment<6>(6 * static_cast<Eigen::Index>(part)));
}

void PartsSolver::analyse(const BlockMatrix& a) {
  rows_ = 3 * static_cast<Eigen::Index>(a.size);
  tissue_->analyse(a);
}

bool PartsSolver::factorise(const BlockMatrix& a) {
  if (!tissue_->factorise(a)) return false;
  z_.setZero(rows_, parts_.rows());
  for (const RigidParts::Entry& entry : parts_.border()) z_.block<3, 6>(3 * entry.node, 6 * entry.part) += entry.value;
  tissue_->solve_many(z_);
  Eigen::MatrixXd S = parts_.corner();
  for (const RigidParts::Entry& entry : parts_.border())
    S.middleRows<6>(6 * entry.part).noalias() -= entry.value.transpose() * z_.middleRows<3>(3 * entry.node);
  schur_.compute(0.5 * (S + S.transpose()));
  return schur_.info() == Eigen::Success && S.allFinite();
}

Eigen::MatrixXd PartsSolver::move_parts(const Eigen::Ref<const Rows>& y, Eigen::MatrixXd p) const {
  for (const RigidParts::Entry& entry : parts_.border())
    p.middleRows<6>(6 * entry.part).noalias() -= entry.value.transpose() * y.middleRows<3>(3 * entry.node);
  schur_.solveInPlace(p);
  return p;
}

void PartsSolver::solve(const Vector& b, Vector& x) const {
  Vector y = x.head(rows_);
  tissue_->solve(b.head(rows_), y);
  const Eigen::MatrixXd p = move_parts(Rows(y), b.tail(parts_.rows()));
  x.head(rows_) = y;
  x.head(rows_).noalias() -= z_ * p.col(0);
  x.tail(parts_.rows()) = p;
}

void PartsSolver::solve_many(Eigen::Ref<Rows> columns) const {
  tissue_->solve_many(columns.topRows(rows_));
  const Eigen::MatrixXd p = move_parts(columns.topRows(rows_), columns.bottomRows(parts_.rows()));
  columns.topRows(rows_).noalias() -= z_ * p;
  columns.bottomRows(parts_.rows()) = p;
}

// B^T A^-1 B = B_t^T A_tt^-1 B_t + q^T S^-1 q,  q = B_p - Z^T B_t.
void PartsSolver::solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const {
  const auto nodes = static_cast<std::uint32_t>(rows_ / 3);
  ASSERT(3 * static_cast<Eigen::Index>(b.size) == rows_ + parts_.rows());
  BlockColumns of_tissue;
  of_tissue.clear(nodes);
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(parts_.rows(), 3 * b.count());
  for (Eigen::Index c = 0; c < b.count(); ++c) {
    for (const BlockColumns::Entry& entry : b.of(c))
      if (entry.row < nodes) {
        of_tissue.entries.push_back(entry);
        q.middleCols<3>(3 * c).noalias() -= z_.middleRows<3>(3 * entry.row).transpose() * entry.value;
      } else {
        q.block<3, 3>(3 * (entry.row - nodes), 3 * c) += entry.value;
      }
    of_tissue.close();
  }
  tissue_->solve_gram(of_tissue, gram);
  const Eigen::MatrixXd half = schur_.matrixL().solve(q);
  gram.noalias() += half.transpose() * half;
}

}  // namespace pliant
