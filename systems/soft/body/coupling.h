// The viscoelastic coupling between a haptic device and the handle (methods.md 2.3), the same for the soft step and the
// touch tick. Spring and damper are saturated separately, in translation and in rotation:
//   F = s(k_t (x_d - x)) + s(b_t (v_d - v)),   tau = s(k_r log(q_d q^-1)) + s(b_r (omega_d - omega)),
//   s(f) = F_max tanh(|f| / F_max) f / |f|.
// Saturated separately, a strained spring does not weaken the damper. Saturated together, a handle far from its device
// would swing through it undamped.
//
// Two linearisations. The tangents are the force's derivatives. The secants g = |s(f)| / |f| freeze the factor by which
// saturation weakens spring and damper. Their quadratic touches the coupling's energy from above (tanh is concave, and
// rotations close faster than their vectors). A step implicit in the secants therefore never gains energy, for any T. A
// step implicit in the tangents may, when it crosses from the saturated range into the slope. Measured from 0.1 m away,
// with T = 0.1 s: seven times the initial energy.
#pragma once

#include "components/soft_body.h"
#include "systems/soft/body/handle.h"

namespace pliant {

struct CouplingForce {
  Vector6 wrench = Vector6::Zero();     // [N], [N m] world, on the handle at its origin; the device gets the negative
  Matrix6 stiffness = Matrix6::Zero();  // [N/m], [N m/rad] -dF/dx of the handle; symmetric, positive semidefinite:
                                        // without the torque's skew part, which does no work
  Matrix6 damping = Matrix6::Zero();    // [N s/m], [N m s/rad] -dF/dw; symmetric, positive semidefinite
  Vector6 secant_stiffness = Vector6::Zero();  // diagonals of the secants, same units
  Vector6 secant_damping = Vector6::Zero();
};

// `device`: target pose of the handle's frame (RigidMotion::at of the device's pose with the handle's centre()).
// Allocates nothing; finite for finite input of any size.
CouplingForce coupling_force(const Handle6& handle, const RigidMotion& motion, const RigidMotion& device);

// [J] stored by the springs.
double coupling_energy(const Handle6& handle, const RigidMotion& motion, const RigidMotion& device);

// A step of T [s], implicit in the secants, for constant device velocity:
//   (M + matrix) w = M w0 + right + ...,   matrix = T B + T^2 K,   right = T (wrench + B w0 + T K w_d).
struct CouplingStep {
  Vector6 matrix = Vector6::Zero();  // diagonal
  Vector6 right = Vector6::Zero();   // [N s], [N m s]
};
CouplingStep coupling_step(const CouplingForce& force, const RigidMotion& motion, const RigidMotion& device, double T);

}  // namespace pliant
