// A body that may have a rigid handle: what holds it, and what the soft step says about the handle. The last six
// degrees of freedom of a body with a handle are the handle's twist w (handle.h). Kinds: tissue on a handle
// (soft_body_state.h), a rigid instrument (rigid_tool.h).
//
// The hand enters the soft step implicitly. The touch clock moves the handle at 1 kHz against the device; the soft step
// takes it to where that path has led, and lets it give way there with the impedance that handle and coupling have,
//   (M_h + T B_c + T^2 K_c) (w - w_1) = T (F - F_1),
// w_1 the twist that leads there, F_1 the mean wrench of tissue and contacts on the way as the touch clock found it, F
// the step's own. Where both agree the handle arrives; where they do not, other bodies feel a hand, not a wall.
#pragma once

#include <array>
#include <optional>

#include "components/soft_body.h"
#include "systems/soft/body/body.h"
#include "systems/soft/body/coupling.h"
#include "systems/soft/body/handle.h"

namespace pliant {

// Of HandleParameters, what may change between steps.
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

  // --- What holds the handle. Only with a handle.
  // The device: its pose and velocity (of the frame that the object's own frame is to follow), now; it is taken to keep
  // that velocity for a step. Not finite: released.
  void set_device(const Pose& pose, const Vector6& velocity);
  void release_device() { device_.reset(), led_.reset(); }
  // From now on the handle is moved as it is told, whatever pulls at it: its centre to `end` over the next step.
  void lead_handle(const RigidMotion& end) { led_ = {end, Vector6::Zero(), true}; }
  // The same, but it gives way as a hand does where tissue and contacts pull otherwise than by `expected` [N], [N m],
  // the mean over the step.
  void bring_handle(const RigidMotion& end, const Vector6& expected) { led_ = {end, expected, false}; }
  // [m], [rad] from where `handle` ends a step to where it was led; zero where it is not led.
  Vector6 short_of_lead(const RigidMotion& handle) const;
  bool held() const { return device_.has_value(); }  // a device holds the handle
  // Where the device wants the handle's own frame.
  RigidMotion device_target() const { return device_ ? device_->at(handle_->centre()) : handle_->motion(); }

  // Before the first step: the body as it rests under gravity while its handle is held where it is. It knows of no
  // contacts. Nothing to do for what is rigid.
  virtual void settle(dvec3 gravity) { (void)gravity; }
  virtual void unsettle() = 0;  // to the rest shape, where the handle is

  // The whole tool in its rest shape, at rest, its own frame where the device is. Before free_step.
  void set_back();

  // --- Of the handle; all of the last free_step, at its beginning, unless said otherwise. Only with a handle.
  // [-Z; 1], size() x 6: how the whole tool moves when the handle is moved and tissue follows.
  virtual const Rows& follow() const = 0;
  // columns = A_tt^-1 columns, rows of tissue alone: the handle held still.
  virtual void solve_held(Eigen::Ref<Rows> columns) const = 0;
  // J_h - J_t Z: out (3 x 6) += sign * axes^T times how a collision mesh point moves with the handle when tissue
  // follows.
  void handle_rows(const SurfacePoint& point, const dmat3& axes, double sign, Eigen::Ref<Rows> out) const {
    gather(point, axes, sign, follow(), out);
  }
  const Matrix6& handle_mass() const { return handle_mass_; }  // M_h [kg], [kg m2]
  // [N], [N m] at the centre: M_h's weight, and what carries the tool while a device holds it.
  const Vector6& handle_load() const { return handle_load_; }
  // What tissue does to the handle in this step, as a linear function of the handle's velocity w over it:
  //   T F(w) = T tissue_wrench - tissue_matrix (w - w0),  w0 the velocity at the step's beginning,
  // mass-proportional damping of M_h included; its inertia and weight, coupling and contacts left out.
  const Matrix6& tissue_matrix() const { return tissue_matrix_; }  // [kg], [kg m2] symmetric, positive semidefinite
  const Vector6& tissue_wrench() const { return tissue_wrench_; }  // [N], [N m] world, at the centre, for w = w0
  const CouplingForce& coupling() const { return coupling_; }  // at the step's beginning; zero while released or led
  // [N], [N m] world, on the handle at its centre: what the coupling did over the step, with the velocity as it is now.
  Vector6 coupling_wrench() const;
  // The same of tissue and contacts together: what the handle's momentum and the coupling leave over.
  Vector6 handle_wrench() const;

  const Vector& velocity() const override { return velocity_; }
  void correct(const Vector& dv) override { velocity_ += dv; }

 protected:
  // Where the hand leads the handle over a step.
  struct Lead {
    RigidMotion end;    // of its centre
    Vector6 expected;   // [N], [N m] of tissue and contacts, mean over the step
    bool told = false;  // it goes there whatever pulls at it
  };

  // Finds coupling_step_, handle_mass_ and handle_load_. What the handle obeys beside tissue and contacts:
  //   (M_h + matrix) w = M_h w0 + right + T handle_load.
  void couple(double T, dvec3 gravity);

  Handle6 settings_;
  std::optional<RigidHandle> handle_;
  double mass_ = 0.0;  // [kg] of the whole tool
  dvec3 balance_{0};   // [m] from the handle's centre to that mass's, at rest, object axes
  double T_ = 0.0;     // [s] of the last free_step
  Vector velocity_;
  std::optional<RigidMotion> device_;
  std::optional<Lead> led_;
  CouplingForce coupling_;
  CouplingStep coupling_step_;
  Vector6 start_ = Vector6::Zero();  // w0
  Matrix6 handle_mass_ = Matrix6::Zero(), tissue_matrix_ = Matrix6::Zero();
  Vector6 handle_load_ = Vector6::Zero(), tissue_wrench_ = Vector6::Zero();
  Vector6 carry_ = Vector6::Zero();  // [N], [N m] the part of handle_load that holds the whole tool up

 private:
  Vector6 support(dvec3 gravity) const;
};

}  // namespace pliant
