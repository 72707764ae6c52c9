// A body that may have a rigid handle: the constraints on the handle, and the step's response at it. The last six
// degrees of freedom of a body with a handle are the handle's twist w (handle.h). Kinds: tissue on a handle
// (soft_body_state.h), a rigid instrument (rigid_tool.h).
//
// The hand enters the soft step implicitly. The touch clock moves the handle at 1 kHz against the device. The soft step
// moves it to the end of that path, with the impedance of handle and coupling,
//   (M_h + S B_c + S^2 K_c) (w - w_1) = T (F - F_1).
// S: the longer of step and touch tick.
// w_1: the twist that leads there; F_1: the mean wrench of tissue and contacts on that path, from the touch clock; F:
// the step's wrench. If both agree the handle arrives; if not, other bodies feel a hand, not a wall.
#pragma once

#include <array>
#include <optional>

#include "components/soft_body.h"
#include "systems/soft/body/body.h"
#include "systems/soft/body/coupling.h"
#include "systems/soft/body/handle.h"

namespace pliant {

// The parameters of HandleParameters that may change between steps.
struct CouplingSetting {
  std::array<double, 2> translation, rotation;
  double max_force, max_torque;
};

class ToolBody : public Body {
 public:
  const ToolBody* as_tool() const override { return this; }
  ToolBody* as_tool() override { return this; }
  void set_coupling(const CouplingSetting& now) {
    settings_.translation = now.translation;
    settings_.rotation = now.rotation;
    settings_.max_force = now.max_force;
    settings_.max_torque = now.max_torque;
  }
  bool has_handle() const { return handle_.has_value(); }
  const RigidHandle& handle() const { return *handle_; }  // now

  // --- Constraints on the handle. Only with a handle.
  // The device: its current pose and velocity (of the target for the object's frame); the velocity is assumed constant
  // over a step. Not finite: released.
  void set_device(const Pose& pose, const Vector6& velocity);
  void release_device() { device_.reset(), prescribed_.reset(); }
  // From now on the handle's motion is prescribed: its centre moves to `end` over the next step, regardless of forces.
  void prescribe_handle(const RigidMotion& end) { prescribed_ = {end, Vector6::Zero(), 0.0, true}; }
  // The same, but compliant like a hand: it deviates if tissue and contacts pull otherwise than by `expected` [N], [N
  // m], the mean over the step. The hand's impedance is that over at least `span` [s]: steps shorter than a touch tick
  // each go all the way that is left, and a lighter hand would never arrive.
  void bring_handle(const RigidMotion& end, const Vector6& expected, double span = 0.0) {
    prescribed_ = {end, expected, span, false};
  }
  // [m], [rad] from `handle` at the end of a step to its prescribed pose; zero without one.
  Vector6 short_of_prescribed(const RigidMotion& handle) const;
  // M_h + S B_c + S^2 K_c of the last step with a compliant path.
  Matrix6 prescribed_impedance() const;
  bool held() const { return device_.has_value(); }  // a device holds the handle
  // Target of the device for the handle's frame.
  RigidMotion device_target() const { return device_ ? device_->at(handle_->centre()) : handle_->motion(); }

  // Before the first step: moves the body to its equilibrium under gravity with the handle fixed. Contacts are ignored.
  // Does nothing for rigid bodies.
  virtual void settle(dvec3 gravity) { (void)gravity; }
  virtual void unsettle() = 0;  // to the rest shape, at the handle

  // Resets the whole tool to its rest shape, at rest, with its frame at the device. Before free_step.
  void set_back();

  // --- The handle's equations, of the last free_step, at its beginning, unless stated otherwise. Only with a handle.
  // [-Z; 1], size() x 6: motion of the whole tool when the handle is moved and tissue follows.
  virtual const Rows& follow() const = 0;
  // columns = A_tt^-1 columns, rows of tissue alone: the handle fixed.
  virtual void solve_held(Eigen::Ref<Rows> columns) const = 0;
  // J_h - J_t Z: out (3 x 6) += sign * axes^T times the motion of a collision mesh point with the handle when tissue
  // follows.
  void handle_rows(const SurfacePoint& point, const dmat3& axes, double sign, Eigen::Ref<Rows> out) const {
    gather(point, axes, sign, follow(), out);
  }
  const Matrix6& handle_mass() const { return handle_mass_; }  // M_h [kg], [kg m2]
  // [N], [N m] at the centre: M_h's weight, and the force that supports the tool while it has a device.
  const Vector6& handle_load() const { return handle_load_; }
  // Wrench of tissue on the handle in this step, as a linear function of the handle's velocity w over it:
  //   T F(w) = T tissue_wrench - tissue_matrix (w - w0),  w0 the velocity at the step's beginning,
  // including mass-proportional damping of M_h, without its inertia and weight, coupling and contacts.
  const Matrix6& tissue_matrix() const { return tissue_matrix_; }  // [kg], [kg m2] symmetric, positive semidefinite
  const Vector6& tissue_wrench() const { return tissue_wrench_; }  // [N], [N m] world, at the centre, for w = w0
  const CouplingForce& coupling() const {
    return coupling_;
  }  // at the step's beginning; zero while released or
     // prescribed
  // [N], [N m] world, on the handle at its centre: the coupling's wrench over the step, for the current velocity.
  Vector6 coupling_wrench() const;
  // The coupling's law at the end of the step, for a handle that ends it with `end`.
  Vector6 coupling_at(const RigidMotion& end) const;
  // The same of tissue and contacts together: the remainder of the handle's momentum and the coupling.
  Vector6 handle_wrench() const;

  const Vector& velocity() const override { return velocity_; }
  void correct(const Vector& dv) override { velocity_ += dv; }

 protected:
  // Prescribed motion of the handle over a step.
  struct PrescribedMotion {
    RigidMotion end;         // of its centre
    Vector6 expected;        // [N], [N m] of tissue and contacts, mean over the step
    double span = 0.0;       // [s]
    bool kinematic = false;  // independent of forces
  };

  // Computes coupling_step_, handle_mass_ and handle_load_. The handle's equation without tissue and contacts:
  //   (M_h + matrix) w = M_h w0 + right + T handle_load.
  void couple(double T, dvec3 gravity);

  Handle6 settings_;
  std::optional<RigidHandle> handle_;
  double mass_ = 0.0;  // [kg] of the whole tool
  dvec3 balance_{0};   // [m] from the handle's centre to that mass's, at rest, object axes
  double T_ = 0.0;     // [s] of the last free_step
  Vector velocity_;
  std::optional<RigidMotion> device_;
  std::optional<PrescribedMotion> prescribed_;
  CouplingForce coupling_;
  CouplingStep coupling_step_;
  Vector6 start_ = Vector6::Zero();  // w0
  Matrix6 handle_mass_ = Matrix6::Zero(), tissue_matrix_ = Matrix6::Zero();
  Vector6 handle_load_ = Vector6::Zero(), tissue_wrench_ = Vector6::Zero();
  Vector6 carry_ = Vector6::Zero();  // [N], [N m] the part of handle_load that supports the whole tool

 private:
  Vector6 support(dvec3 gravity) const;
};

}  // namespace pliant
