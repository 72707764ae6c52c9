// Rigid bodies: RigidState has six degrees of freedom, FixedBody none (its motion may be prescribed).
#pragma once

#include "components/transform.h"
#include "systems/soft/body/immovable_body.h"

namespace pliant {

// Newton-Euler equations. Degrees of freedom: velocity of the centre of mass [m/s], angular velocity [rad/s], world
// frame. The state is the angular momentum L, which only contacts change. A free body rotates with q' = exp(h w) q, w =
// I(exp(h w/2) q)^-1 L (midpoint, neither damped nor driven). The step is divided into as many parts as its spin
// requires. The v* of the step is the mean angular velocity of that rotation.
class RigidState : public Body {
 public:
  const RigidState* as_rigid() const override { return this; }
  RigidState(const Mesh& surface, const Pose& pose, const RigidMass& mass);

  int size() const override { return 6; }
  void free_step(double T, dvec3 gravity) override;
  const Vector& velocity() const override { return velocity_; }
  void push(const SurfacePoint& point, dvec3 impulse, Rows& columns, Eigen::Index column) const override;
  void gather(const SurfacePoint& point, const dmat3& axes, double sign, const Rows& x,
              Eigen::Ref<Rows> out) const override;
  void solve(Rows& columns) const override;
  void load(dvec3 force, dvec3 torque, Rows& column) const override;
  void place(const Pose& pose) override;
  void correct(const Vector& dv) override;
  void move_surface(std::vector<dvec3>& out) const override;
  std::optional<RigidPath> path() const override { return path_of(velocity_); }
  std::optional<RigidPath> last_path() const override { return path_of(start_); }
  void advance(double T) override;
  void weigh(const Rows& x, Rows& out) const override;
  Vector starting_velocity() const override { return start_; }
  void halt() override;
  void set_mass(const RigidMass& mass) override;
  void start_with(dvec3 velocity) override { set_velocity(velocity, dvec3(0)); }
  std::optional<Pose> pose_after(double T) const override;
  bool stiffen_turning(const dmat3& stiffness, double T) override;
  void show(SoftObjectSnapshot& out) const override;

  const RigidMass& mass() const { return mass_; }
  const dvec3& centre() const { return centre_; }                      // [m] world
  const dquat& rotation() const { return rotation_; }                  // object to world
  const dvec3& angular_momentum() const { return angular_momentum_; }  // [kg m2/s] world, about the centre
  Pose pose() const { return {centre_ - rotation_ * mass_.centre, rotation_}; }
  // linear [m/s] of the centre of mass, angular [rad/s], world.
  void set_velocity(dvec3 linear, dvec3 angular);
  double kinetic_energy() const;  // [J] at the current attitude

 private:
  dmat3 inertia(const dquat& rotation) const;          // [kg m2] world
  dmat3 inverse_inertia(const dquat& rotation) const;  // world
  dvec3 free_turn(double T) const;                     // [rad/s] mean angular velocity of the step without contacts
  RigidPath path_of(const Vector& v) const { return {centre_, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}}; }
  void turn_stiffly();  // sets the step's spin without contacts, by stiffened_
  void refresh_surface();

  RigidMass mass_;
  dvec3 centre_{0};
  dquat rotation_{1, 0, 0, 0};
  dvec3 linear_{0};            // [m/s]
  dvec3 angular_momentum_{0};  // [kg m2/s]
  dmat3 inverse_inertia_{1};   // at the beginning of the step
  dmat3 stiffened_{0};         // [kg m2] stiffen_turning's part of the inertia
  dvec3 spin_{0}, begun_{0};   // [rad/s] of the step without it; angular momentum at its beginning
  Vector velocity_ = Vector::Zero(6), start_ = Vector::Zero(6);
};

// Ground, walls, and scripted fingers: contacts cannot move it.
class FixedBody : public ImmovableBody {
 public:
  FixedBody(const Mesh& surface, const Pose& pose);

  // Prescribes its motion from now on: velocity of its origin [m/s], and angular velocity about it [rad/s], world.
  void set_velocity(dvec3 linear, dvec3 angular);
  // [m/N] > 0: compliance of contacts along their normals (pads of a gripper); 0: rigid.
  double compliance = 0.0;

  void free_step(double T, dvec3 gravity) override;
  void advance(double T) override;
  bool yields() const override { return compliance > 0.0; }
  void add_compliance(std::span<const Side> sides, double T, Eigen::MatrixXd& w) const override;
  void place(const Pose& pose) override;
  std::optional<Pose> pose_after(double T) const override;
  dvec3 velocity_of(const SurfacePoint& point) const override;
  bool prescribed() const override { return linear_ != dvec3(0) || angular_ != dvec3(0); }
  void show(SoftObjectSnapshot& out) const override;
  const Pose& pose() const { return pose_; }

 private:
  void refresh_surface();

  Pose pose_;
  dvec3 linear_{0}, angular_{0};
};

}  // namespace pliant
