#include "systems/soft/body/rigid_state.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "runtime/assert.h"
#include "systems/soft/body/rotation_vector.h"

namespace pliant {
namespace {

constexpr double kTurnPerPart = 0.1;  // [rad] largest part into which a free rotation is divided
constexpr int kMostStepParts = 256;

void place_surface(const Mesh& mesh, const Pose& pose, std::vector<dvec3>& surface_position) {
  const dmat3 r = glm::mat3_cast(pose.rotation);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
    surface_position[v] = pose.position + r * dvec3(mesh.position(v));
}

// Velocities of points that rotate with `angular` about `centre`, which moves with `linear`.
void move_points(const std::vector<dvec3>& points, dvec3 centre, dvec3 linear, dvec3 angular, std::vector<dvec3>& out) {
  out.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) out[i] = linear + cross(angular, points[i] - centre);
}

}  // namespace

RigidState::RigidState(const Mesh& mesh, const Pose& pose, const RigidMass& mass)
    : mass_(mass), centre_(pose.to_world(mass.centre)), rotation_(normalize(pose.rotation)) {
  ASSERT(mass.mass > 0.0 && glm::determinant(mass.inertia) > 0.0);
  collision_mesh = &mesh;
  surface_position.resize(mesh.vertex_count);
  surface_velocity.resize(mesh.vertex_count, dvec3(0));
  inverse_inertia_ = inverse_inertia(rotation_);
  refresh_surface();
}

dmat3 RigidState::inertia(const dquat& rotation) const {
  const dmat3 r = glm::mat3_cast(rotation);
  return r * mass_.inertia * glm::transpose(r);
}
dmat3 RigidState::inverse_inertia(const dquat& rotation) const {
  return glm::inverse(inertia(rotation));
}

void RigidState::set_velocity(dvec3 linear, dvec3 angular) {
  linear_ = linear;
  angular_momentum_ = inertia(rotation_) * angular;
  velocity_ << linear.x, linear.y, linear.z, angular.x, angular.y, angular.z;
}

void RigidState::set_mass(const RigidMass& mass) {
  const dvec3 spin = inverse_inertia(rotation_) * angular_momentum_;
  mass_ = mass;
  set_velocity(linear_, spin);
}

double RigidState::kinetic_energy() const {
  return 0.5 * mass_.mass * dot(linear_, linear_) +
         0.5 * dot(angular_momentum_, inverse_inertia(rotation_) * angular_momentum_);
}

dvec3 RigidState::free_turn(double T) const {
  const double spin = length(inverse_inertia_ * angular_momentum_);
  const int parts = std::clamp(static_cast<int>(std::ceil(spin * T / kTurnPerPart)), 1, kMostStepParts);
  const double h = T / parts;
  dquat q = rotation_;
  for (int i = 0; i < parts; ++i) {
    dvec3 w = inverse_inertia(q) * angular_momentum_;
    // A contraction by about h |w| < 0.1: eight iterations converge to rounding.
    for (int k = 0; k < 8; ++k) w = inverse_inertia(rotation_of(0.5 * h * w) * q) * angular_momentum_;
    q = rotation_of(h * w) * q;
  }
  return vector_of(q * glm::conjugate(rotation_)) / T;
}

void RigidState::free_step(double T, dvec3 gravity) {
  inverse_inertia_ = inverse_inertia(rotation_);
  const dvec3 spin = inverse_inertia_ * angular_momentum_;
  start_ << linear_.x, linear_.y, linear_.z, spin.x, spin.y, spin.z;
  const dvec3 v = carried ? linear_ : linear_ + T * gravity;
  spin_ = free_turn(T), begun_ = angular_momentum_;
  velocity_ << v.x, v.y, v.z, spin_.x, spin_.y, spin_.z;
  if (stiffened_ != dmat3(0.0)) turn_stiffly();
  move_surface(surface_velocity);
}

// (I + a) w = I w_free: implicit in the turn, so that the spin of what is stiff fades.
void RigidState::turn_stiffly() {
  const dmat3 plain = inertia(rotation_);
  inverse_inertia_ = glm::inverse(plain + stiffened_);
  const dvec3 w = inverse_inertia_ * (plain * spin_);
  for (int k = 0; k < 3; ++k) velocity_[3 + k] = w[k];
  angular_momentum_ = begun_ + plain * (w - spin_);
}

bool RigidState::stiffen_turning(const dmat3& stiffness, double T) {
  using Square = Eigen::Matrix3d;
  const dmat3 plain = inertia(rotation_), excess = 0.5 * T * T * stiffness - plain;
  const Square symmetric = Eigen::Map<const Square>(&excess[0][0]);
  const Eigen::SelfAdjointEigenSolver<Square> axes(symmetric);
  const Eigen::Vector3d values = axes.eigenvalues().cwiseMax(0.0);
  const Square positive = axes.eigenvectors() * values.asDiagonal() * axes.eigenvectors().transpose();
  const auto trace = [](const dmat3& m) { return m[0][0] + m[1][1] + m[2][2]; };
  const bool grew = positive.trace() > 1.2 * trace(stiffened_) + 0.2 * trace(plain);
  std::copy_n(positive.data(), 9, &stiffened_[0][0]);
  if (grew) {
    turn_stiffly();
    move_surface(surface_velocity);
  }
  return grew;
}

void RigidState::move_surface(std::vector<dvec3>& out) const {
  const double* const v = velocity_.data();
  move_points(surface_position, centre_, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}, out);
}

void RigidState::push(const SurfacePoint& point, dvec3 impulse, Rows& columns, Eigen::Index column) const {
  const dvec3 turn = cross(point.position - centre_, impulse);
  for (int k = 0; k < 3; ++k) {
    columns(k, column) += impulse[k];
    columns(3 + k, column) += turn[k];
  }
}

void RigidState::gather(const SurfacePoint& point, const dmat3& axes, double sign, const Rows& x,
                        Eigen::Ref<Rows> out) const {
  const dvec3 r = point.position - centre_;
  for (int c = 0; c < 3; ++c) {
    const dvec3 f = sign * axes[c], m = cross(r, f);
    for (int k = 0; k < 3; ++k) out.row(c) += f[k] * x.row(k) + m[k] * x.row(3 + k);
  }
}

void RigidState::solve(Rows& columns) const {
  columns.topRows(3) /= mass_.mass;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    const dvec3 w = inverse_inertia_ * dvec3(columns(3, c), columns(4, c), columns(5, c));
    for (int k = 0; k < 3; ++k) columns(3 + k, c) = w[k];
  }
}

void RigidState::weigh(const Rows& x, Rows& out) const {
  out.resize(6, x.cols());
  out.topRows(3) = mass_.mass * x.topRows(3);
  const dmat3 turning = inertia(rotation_);
  for (int row = 0; row < 3; ++row)
    out.row(3 + row) = turning[0][row] * x.row(3) + turning[1][row] * x.row(4) + turning[2][row] * x.row(5);
}

void RigidState::load(dvec3 force, dvec3 torque, Rows& column) const {
  for (int k = 0; k < 3; ++k) column(k, 0) += force[k], column(3 + k, 0) += torque[k];
}

void RigidState::place(const Pose& pose) {
  rotation_ = normalize(pose.rotation);
  centre_ = pose.position + rotation_ * mass_.centre;
  halt();
  refresh_surface();
}

void RigidState::correct(const Vector& dv) {
  velocity_ += dv;
  angular_momentum_ += inertia(rotation_) * dvec3(dv[3], dv[4], dv[5]);
}

std::optional<Pose> RigidState::pose_after(double T) const {
  const double* const v = velocity_.data();
  const dquat rotation = normalize(rotation_of(T * dvec3(v[3], v[4], v[5])) * rotation_);
  return Pose{centre_ + T * dvec3(v[0], v[1], v[2]) - rotation * mass_.centre, rotation};
}

void RigidState::advance(double T) {
  linear_ = {velocity_[0], velocity_[1], velocity_[2]};
  centre_ += T * linear_;
  rotation_ = normalize(rotation_of(T * dvec3(velocity_[3], velocity_[4], velocity_[5])) * rotation_);
  refresh_surface();
}

void RigidState::halt() {
  linear_ = angular_momentum_ = dvec3(0);
  velocity_.setZero();
  std::fill(surface_velocity.begin(), surface_velocity.end(), dvec3(0));
}

void RigidState::refresh_surface() {
  place_surface(*collision_mesh, pose(), surface_position);
}

void RigidState::show(SoftObjectSnapshot& out) const {
  out.object = entity;
  out.pose = pose();
}

FixedBody::FixedBody(const Mesh& mesh, const Pose& pose) : pose_{pose.position, normalize(pose.rotation)} {
  collision_mesh = &mesh;
  surface_position.resize(mesh.vertex_count);
  surface_velocity.resize(mesh.vertex_count, dvec3(0));
  refresh_surface();
}

void FixedBody::set_velocity(dvec3 linear, dvec3 angular) {
  linear_ = linear;
  angular_ = angular;
}

void FixedBody::free_step(double, dvec3) {
  move_points(surface_position, pose_.position, linear_, angular_, surface_velocity);
}

std::optional<Pose> FixedBody::pose_after(double T) const {
  if (linear_ == dvec3(0) && angular_ == dvec3(0)) return pose_;
  return Pose{pose_.position + T * linear_, normalize(rotation_of(T * angular_) * pose_.rotation)};
}
dvec3 FixedBody::velocity_of(const SurfacePoint& point) const {
  return linear_ + cross(angular_, point.position - pose_.position);
}

void FixedBody::advance(double T) {
  if (linear_ == dvec3(0) && angular_ == dvec3(0)) return;
  pose_ = *pose_after(T);
  refresh_surface();
}

// A spring under each contact: gap = g0 + T u + compliance lambda / T. Only along the normal: a tangential spring would
// need to store its anchor, and without it creeps.
void FixedBody::add_compliance(std::span<const Side> sides, double T, Eigen::MatrixXd& w) const {
  if (compliance <= 0.0) return;
  for (const Side& side : sides) w(3 * side.contact, 3 * side.contact) += compliance / (T * T);
}

void FixedBody::place(const Pose& pose) {
  pose_ = {pose.position, normalize(pose.rotation)};
  refresh_surface();
}

void FixedBody::refresh_surface() {
  place_surface(*collision_mesh, pose_, surface_position);
}

void FixedBody::show(SoftObjectSnapshot& out) const {
  out.object = entity;
  out.pose = pose_;
}

}  // namespace pliant
