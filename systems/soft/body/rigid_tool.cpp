#include "systems/soft/body/rigid_tool.h"

#include <algorithm>

#include "runtime/assert.h"

namespace pliant {

RigidTool::RigidTool(const Mesh& mesh, const RigidMass& mass, const Handle6& handle, const Pose& placement) {
  ASSERT(mass.mass > 0.0 && glm::determinant(mass.inertia) > 0.0);
  collision_mesh = &mesh;
  settings_ = handle;
  handle_.emplace(mass.mass, mass.centre, mass.inertia, Pose{placement.position, normalize(placement.rotation)});
  mass_ = mass.mass;
  velocity_ = Vector::Zero(6);
  surface_position.resize(mesh.vertex_count);
  surface_velocity.assign(mesh.vertex_count, dvec3(0));
  refresh_surface();
}

void RigidTool::set_mass(const RigidMass& mass) {
  const RigidMotion motion = handle_->motion();
  handle_.emplace(mass.mass, mass.centre, mass.inertia, handle_->object_pose());
  handle_->set_velocity(motion.velocity);
  mass_ = mass.mass;
}

void RigidTool::free_step(double T, dvec3 gravity) {
  T_ = T;
  couple(T, gravity);
  Matrix6 A = handle_mass_;
  A.diagonal() += coupling_step_.matrix;
  factor_.compute(A);
  solvable_ = factor_.info() == Eigen::Success && A.allFinite();
  if (solvable_)
    velocity_ = factor_.solve(handle_mass_ * start_ + T * handle_load_ + coupling_step_.right);
  else
    velocity_.setZero();
  move_surface(surface_velocity);
}

void RigidTool::push(const SurfacePoint& point, dvec3 impulse, Rows& columns, Eigen::Index column) const {
  columns.col(column) += join(impulse, cross(point.position - handle_->motion().pose.position, impulse));
}

void RigidTool::gather(const SurfacePoint& point, const dmat3& axes, double sign, const Rows& x,
                       Eigen::Ref<Rows> out) const {
  const dvec3 arm = point.position - handle_->motion().pose.position;
  for (int k = 0; k < 3; ++k) out.row(k) += sign * join(axes[k], cross(arm, axes[k])).transpose() * x;
}

void RigidTool::solve(Rows& columns) const {
  columns = factor_.solve(columns).eval();
}

void RigidTool::respond(std::span<const PushedSide> sides, Eigen::Index contacts, Compliance& out) const {
  out.held.setZero(3 * contacts, 3 * contacts);
  Rows moved = Rows::Zero(3 * contacts, 6);
  for (const PushedSide& side : sides)
    handle_rows(*side.point, *side.axes, side.sign, moved.middleRows<3>(3 * side.contact));
  // J A^-1 J^T = (J L^-T) (J L^-T)^T.
  const Eigen::MatrixXd levered = factor_.matrixL().solve(moved.transpose());
  out.lever = levered.transpose();
}

void RigidTool::move_surface(std::vector<dvec3>& out) const {
  out.resize(surface_position.size());
  const dvec3 centre = handle_->motion().pose.position, v = linear(velocity_), w = angular(velocity_);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = v + cross(w, surface_position[i] - centre);
}

std::optional<Pose> RigidTool::pose_after(double T) const {
  RigidHandle after = *handle_;
  after.set_velocity(velocity_);
  after.advance(T);
  return after.object_pose();
}

void RigidTool::advance(double T) {
  handle_->set_velocity(velocity_);
  handle_->advance(T);
  velocity_ = handle_->motion().velocity;
  refresh_surface();
}

void RigidTool::halt() {
  velocity_.setZero();
  std::fill(surface_velocity.begin(), surface_velocity.end(), dvec3(0));
  handle_->set_velocity(Vector6::Zero());
}

void RigidTool::refresh_surface() {
  const Pose pose = handle_->object_pose();
  const dmat3 r = glm::mat3_cast(pose.rotation);
  for (std::uint32_t v = 0; v < collision_mesh->vertex_count; ++v)
    surface_position[v] = pose.position + r * dvec3(collision_mesh->position(v));
}

void RigidTool::show(SoftObjectSnapshot& out) const {
  out.object = entity;
  out.pose = handle_->object_pose();
}

}  // namespace pliant
