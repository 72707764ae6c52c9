// The viscoelastic bond between a haptic device and the handle (methods.md 2.3), the same for the soft step and the
// touch tick. Spring and damper, each saturated by itself, in translation and in rotation:
//   F = s(k_t (x_d - x)) + s(b_t (v_d - v)),   tau = s(k_r log(q_d q^-1)) + s(b_r (omega_d - omega)),
//   s(f) = F_max tanh(|f| / F_max) f / |f|.
// Saturated apart, a strained spring leaves the damper its strength; saturated together, a handle far from its device
// would swing through it undamped.
//
// Two linearisations. The tangents are the force's derivatives. The secants g = |s(f)| / |f| freeze the factor by which
// saturation weakens spring and damper: the quadratic they belong to touches the coupling's energy from above (tanh is
// concave, and rotations close faster than their vectors), so that a step which is implicit in the secants never gains
// energy, whatever T. A step implicit in the tangents may, crossing from the saturated side into the slope: from 0.1 m
// away, with T = 0.1 s, seven times the energy there was (measured).
#pragma once

#include "components/soft_body.h"
#include "systems/soft/body/handle.h"

namespace pliant {

struct CouplingForce {
  Vector6 wrench = Vector6::Zero();     // [N], [N m] world, on the handle at its origin; the device gets minus it
  Matrix6 stiffness = Matrix6::Zero();  // [N/m], [N m/rad] -dF/dx of the handle; symmetric, positive semidefinite:
                                        // the torque's skew part, which does no work, is left out
  Matrix6 damping = Matrix6::Zero();    // [N s/m], [N m s/rad] -dF/dw; symmetric, positive semidefinite
  Vector6 secant_stiffness = Vector6::Zero();  // diagonals of the secants, same units
  Vector6 secant_damping = Vector6::Zero();
};

// `device`: where the device wants the handle's own frame (RigidMotion::at of its pose with the handle's centre()).
// Allocates nothing; finite for finite input of any size.
CouplingForce coupling_force(const Handle6& handle, const RigidMotion& motion, const RigidMotion& device);

// [J] stored by the springs.
double coupling_energy(const Handle6& handle, const RigidMotion& motion, const RigidMotion& device);

// A step of T [s], implicit in the secants, the device keeping its velocity:
//   (M + matrix) w = M w0 + right + ...,   matrix = T B + T^2 K,   right = T (wrench + B w0 + T K w_d).
struct CouplingStep {
  Vector6 matrix = Vector6::Zero();  // diagonal
  Vector6 right = Vector6::Zero();   // [N s], [N m s]
};
CouplingStep coupling_step(const CouplingForce& force, const RigidMotion& motion, const RigidMotion& device, double T);

}  // namespace pliant
