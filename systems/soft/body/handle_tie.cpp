#include "systems/soft/body/handle_tie.h"

#include <cmath>

#include "runtime/assert.h"

namespace pliant {
namespace {

constexpr std::uint32_t kNoNode = 0xffffffffu;

Eigen::Vector3d to_eigen(dvec3 v) {
  return {v.x, v.y, v.z};
}

}  // namespace

HandleTie::HandleTie(Attachment attachment, const TissueMaterial& material, const Tissue& tissue, std::uint32_t first,
                     const RigidParts* parts)
    : attachment_(attachment),
      material_(material),
      first_(first),
      parts_(parts),
      row_of_node_(tissue.moving() + (parts ? 2 * parts->count() : 0), kNoNode) {
  ASSERT(attachment == Attachment::kSlave ? tissue.moving() == first : tissue.moving() > first);
}

void HandleTie::assemble(Tissue& tissue, const RigidHandle& handle, double T, dvec3 gravity) {
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(tissue.moving()), more = parts_ ? parts_->rows() : 0;
  right_.resize(rows + more + 6);
  right_.head(rows) = tissue.right().head(rows);
  if (parts_) right_.segment(rows, more) = parts_->right();
  right_.tail<6>().setZero();
  corner_.setZero();
  if (attachment_ == Attachment::kSlave)
    slave(tissue, handle);
  else
    spring(tissue, handle, T, gravity);
}

Grip& HandleTie::border_at(std::uint32_t block_row) {
  std::uint32_t& at = row_of_node_[block_row];
  if (at == kNoNode) {
    at = static_cast<std::uint32_t>(border_.size());
    border_.push_back({block_row, Grip::Zero()});
  }
  return border_[at].value;
}

void HandleTie::slave(const Tissue& tissue, const RigidHandle& handle) {
  for (HandleRow& row : border_) row.value.setZero();
  const auto on_part = [&](std::uint32_t node) { return parts_ && parts_->has(node); };
  for (const Tissue::Entry& entry : tissue.outer())
    if (!on_part(entry.column)) border_at(entry.row) += entry.value * grip_matrix(handle.arm(entry.column - first_));
  for (const Tissue::Entry& entry : tissue.corner()) {
    if (on_part(entry.column)) continue;
    const Grip moved = entry.value * grip_matrix(handle.arm(entry.column - first_));
    if (!on_part(entry.row)) {
      corner_ += grip_matrix(handle.arm(entry.row - first_)).transpose() * moved;
      continue;
    }
    const auto row = static_cast<std::uint32_t>(tissue.moving() + 2 * parts_->of(entry.row));
    border_at(row) += moved;
    border_at(row + 1) += grip_matrix(parts_->arm(entry.row)).rightCols<3>().transpose() * moved;
  }
  for (std::size_t i = 0; i < handle.node_count(); ++i)
    right_.tail<6>() +=
        grip_matrix(handle.arm(i)).transpose() * tissue.right().segment<3>(3 * static_cast<Eigen::Index>(first_ + i));

  const Matrix6 lent = handle.lent_mass();
  corner_ += lent;
  right_.tail<6>() += lent * handle.motion().velocity;
}

void HandleTie::spring(Tissue& tissue, const RigidHandle& handle, double T, dvec3 gravity) {
  const dvec3 centre = handle.motion().pose.position;
  const double damped = 1.0 + T * material_.alpha;
  border_.resize(handle.node_count());
  for (std::size_t i = 0; i < handle.node_count(); ++i) {
    const auto node = static_cast<std::uint32_t>(first_ + i);
    const double mass = tissue.mass()[node], size = std::cbrt(mass / material_.density);
    const double k = stiffness * material_.young * size, b = 2.0 * std::sqrt(k * mass), s = T * b + T * T * k;
    const dvec3 arm = tissue.position()[node] - centre;
    const Grip G = grip_matrix(arm);
    const Eigen::Vector3d pull = T * k * to_eigen(arm - handle.arm(i));
    const Eigen::Vector3d carried = mass * to_eigen(tissue.velocity()[node] + T * gravity);

    BlockMatrix& inner = tissue.inner();
    inner.value[inner.diagonal[node]].diagonal().array() += s - damped * mass;
    right_.segment<3>(3 * static_cast<Eigen::Index>(node)) -= pull + carried;
    border_[i] = {node, -s * G};
    corner_ += s * G.transpose() * G;
    right_.tail<6>() += G.transpose() * pull;
  }
  const Matrix6 mass = handle.mass_matrix();
  corner_ += damped * mass;
  right_.tail<6>() += mass * (handle.motion().velocity + T * join(gravity, dvec3(0)));
}

}  // namespace pliant
