// The rigid part of a tool (methods.md 2.2): its nodes' lumped masses form one rigid body at their centre of mass. A
// tool's last six degrees of freedom are w = (velocity of the centre, angular velocity), world axes. A node at arm r
// has velocity G w, G = [I, -[r]x]; forces map back by G^T.
#pragma once

#include <span>
#include <vector>

#include "components/math.h"
#include "components/transform.h"
#include "systems/soft/linear/block_matrix.h"

namespace pliant {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Grip = Eigen::Matrix<double, 3, 6>;  // G

// Linear part first: [m/s], [rad/s], or [N], [N m].
inline Vector6 join(dvec3 linear, dvec3 angular) {
  return (Vector6() << linear.x, linear.y, linear.z, angular.x, angular.y, angular.z).finished();
}
inline dvec3 linear(const Vector6& v) {
  return {v[0], v[1], v[2]};
}
inline dvec3 angular(const Vector6& v) {
  return {v[3], v[4], v[5]};
}

// Pose and velocity of a rigid frame. World.
struct RigidMotion {
  Pose pose;
  Vector6 velocity = Vector6::Zero();  // of the frame's origin, and angular
  // The same motion at a point `offset` [m] along the frame's axes.
  RigidMotion at(dvec3 offset) const;
};

Grip grip_matrix(dvec3 arm);  // G

class RigidHandle {
 public:
  // Nodes of the handle at rest [m] and their masses [kg], object frame; `placement`: object to world. `body`: the rest
  // box of the whole body [m]; its inertia substitutes that of nodes on a line (or a single one), which have none about
  // an axis.
  RigidHandle(std::span<const dvec3> nodes, std::span<const double> mass, dvec3 body, const Pose& placement);

  // A rigid body that is its own handle: mass [kg], centre of mass [m] and inertia about it [kg m2], object frame.
  RigidHandle(double mass, dvec3 centre, const dmat3& inertia, const Pose& placement);

  // The centre of mass, with the object's axes.
  const RigidMotion& motion() const { return motion_; }
  // Places it at rest with the object's frame at `object`.
  void place(const Pose& object);
  void set_velocity(const Vector6& w) { motion_.velocity = w; }
  dvec3 centre() const { return centre_; }                  // [m] object frame, of the rest shape
  Pose object_pose() const;                                 // of the object's frame
  dvec3 arm(std::size_t node) const { return arm_[node]; }  // [m] world axes, from the centre to a node, now
  std::size_t node_count() const { return arm_.size(); }

  Matrix6 mass_matrix() const;  // [kg], [kg m2] world axes, about the centre
  Matrix6 lent_mass() const;    // the substituted part of it (usually zero)
  // x += T v, q = exp(T omega) q. Angular momentum is conserved: omega follows the rotated inertia. This integrates the
  // gyroscopic term without the energy gain of the explicit one (-T omega x I omega).
  void advance(double T);

 private:
  void turn_arms();

  dvec3 centre_{0};
  double mass_ = 0.0;           // [kg]
  dmat3 inertia_{1}, lent_{0};  // [kg m2] object axes; lent_ is the substituted part of inertia_
  std::vector<dvec3> rest_arm_, arm_;
  RigidMotion motion_;
};

}  // namespace pliant
