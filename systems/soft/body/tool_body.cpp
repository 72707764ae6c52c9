#include "systems/soft/body/tool_body.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/body/rotation_vector.h"

namespace pliant {
namespace {

constexpr double kLeadMass = 1e4;     // [kg] effective mass of a handle with prescribed motion: far above any tool's
constexpr double kLeadInertia = 1e2;  // [kg m2]

bool all_finite(const RigidMotion& motion) {
  const dvec3 x = motion.pose.position;
  const dquat q = motion.pose.rotation;
  return std::isfinite(dot(x, x)) && std::isfinite(1.0 / glm::dot(q, q)) && motion.velocity.allFinite();
}

// [m], [rad]
Vector6 way_between(const RigidMotion& from, const RigidMotion& to) {
  return join(to.pose.position - from.pose.position, vector_of(to.pose.rotation * glm::conjugate(from.pose.rotation)));
}

}  // namespace

void ToolBody::set_device(const Pose& pose, const Vector6& velocity) {
  RigidMotion device{pose, velocity};
  if (!all_finite(device)) return release_device();
  device.pose.rotation = glm::normalize(pose.rotation);
  device_ = device;
}

// Force that supports the whole tool in its rest shape. Without it, a hand that lifts the weight and lowers it
// elsewhere would get back work that it never put into a surface, which a passive device must not give.
Vector6 ToolBody::support(dvec3 gravity) const {
  if (!(device_ || prescribed_) || !settings_.carried) return Vector6::Zero();
  const dvec3 force = -mass_ * gravity;
  return join(force, cross(handle_->motion().pose.rotation * balance_, force));
}

void ToolBody::set_back() {
  if (!device_) return;
  handle_->place(device_->pose);
  unsettle();
  halt();
}

void ToolBody::couple(double T, dvec3 gravity) {
  const RigidMotion now = handle_->motion();
  start_ = now.velocity;
  handle_mass_ = handle_->mass_matrix();
  carry_ = support(gravity);
  handle_load_ = handle_mass_ * join(gravity, dvec3(0)) + carry_;
  coupling_ = device_ && !prescribed_ ? coupling_force(settings_, now, device_target()) : CouplingForce{};
  coupling_step_ = device_ && !prescribed_ ? coupling_step(coupling_, now, device_target(), T) : CouplingStep{};
  if (!prescribed_) return;
  const Vector6 there = way_between(now, prescribed_->end) / T;
  if (prescribed_->kinematic || !device_) {
    coupling_step_.matrix = join(dvec3(kLeadMass), dvec3(kLeadInertia));
    coupling_step_.right = coupling_step_.matrix.cwiseProduct(there);
    return;
  }
  const double span = std::max(T, prescribed_->span);
  coupling_step_.matrix = coupling_step(coupling_force(settings_, prescribed_->end, device_target()), prescribed_->end,
                                        device_target(), span)
                              .matrix;
  coupling_step_.right = coupling_step_.matrix.cwiseProduct(there) + handle_mass_ * (there - start_) -
                         T * (handle_load_ + prescribed_->expected);
}

Vector6 ToolBody::short_of_prescribed(const RigidMotion& handle) const {
  return prescribed_ ? way_between(handle, prescribed_->end) : Vector6(Vector6::Zero());
}

Matrix6 ToolBody::prescribed_impedance() const {
  if (!prescribed_ || prescribed_->kinematic) return Matrix6::Zero();
  Matrix6 out = handle_mass_;
  out.diagonal() += coupling_step_.matrix;
  return out;
}

Vector6 ToolBody::coupling_wrench() const {
  return (coupling_step_.right - coupling_step_.matrix.cwiseProduct(velocity_.tail<6>())) / T_;
}

Vector6 ToolBody::coupling_at(const RigidMotion& end) const {
  if (!device_) return Vector6::Zero();
  RigidMotion there = *device_;
  there.pose.position += T_ * linear(there.velocity);
  there.pose.rotation = glm::normalize(rotation_of(T_ * angular(there.velocity)) * there.pose.rotation);
  return coupling_force(settings_, end, there.at(handle_->centre())).wrench;
}

Vector6 ToolBody::handle_wrench() const {
  return handle_mass_ * (velocity_.tail<6>() - start_) / T_ - coupling_wrench() - handle_load_;
}

}  // namespace pliant
