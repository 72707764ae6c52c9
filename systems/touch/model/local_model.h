// One vertex as a mass, a damper and a spring along its normal (P1 eq. 1; methods.md 1.1, 1.2):
//   m h'' = -b h' - F(h) + f
// with its exact step for the linear laws, a passive step for the others, and the force laws themselves.
//
// Legend: m mass [kg], b damping [N s/m], k stiffness [N/m], f force [N], h height [m] (< 0: pushed in), v = h' [m/s],
// T step [s]. Only k/m and b/m enter the motion, so fields run with k = 1 (Motion) and do not depend on the mesh.
#pragma once

#include <array>

#include "components/deformable.h"
#include "components/monotone_cubic.h"
#include "components/registered.h"
#include "components/sphere_curve.h"
#include "runtime/result.h"

namespace pliant {

// The four coefficients of a step of length T: h' = hh h + hv v, v' = vh h + vv v, with h measured from f/k.
struct StepCoefficients {
  double hh = 1.0, hv = 0.0, vh = 0.0, vv = 1.0;
};

// Exact for any m, k > 0, b >= 0 (methods.md 1.1): under-, over- and critically damped, spectral radius <= 1.
// m = 0 gives the first-order decay, m = b = 0 the immediate one.
StepCoefficients exact_step(double mass, double damping, double stiffness, double dt);

struct HeightState {
  double height = 0.0;    // [m]
  double velocity = 0.0;  // [m/s]
};

// One exact step under a constant force. Handles every degenerate case, including k = 0.
HeightState step_oscillator(HeightState state, double mass, double damping, double stiffness, double force, double dt);

// The standard linear solid with mass, m h'' = -b h' - k h - q + f, q' = k1 h' - q/tau: exponential of its 3x3 matrix.
// Rows and columns (h, v, q).
std::array<std::array<double, 3>, 3> solid_step(double mass, double damping, double stiffness, double arm_stiffness,
                                                double arm_time, double dt);

// Natural frequency [rad/s] of a free surface that settles to 2 % within `settling_time` at this damping ratio (5.83 /
// settling_time at 1). An undamped surface never settles; it gets the frequency of the critically damped one.
double natural_frequency(double damping_ratio, double settling_time);

// A slow surface creeps rather than coasts: its natural frequency is at least this [rad/s] (10 Hz), which bounds its
// mass. A longer settling time is reached by more damping, with this ratio.
inline constexpr double kSlowest = 2 * 3.14159265358979 * 10;
double creep_ratio(double w0, double settling_time);
// The effective damping ratio: the authored one, or the one required by the settling time.
double damping_of(const Deformable& deformable);

// The function of a law, built in or registered.
const SpringFunction& spring_function(SpringLaw law);

// The restoring law per unit of small-depth stiffness: F(h) = k * restoring(h). Odd, except that the exponential law
// stiffens only under compression (a bulge is linear). [m]
struct RestoringLaw {
  SpringLaw kind = SpringLaw::kLinear;
  double cubic = 0.0;       // [1/m2] k3 / k
  double stiffening = 0.0;  // [1/m] alpha, not 0 of the exponential law
  MonotoneCubic table;      // of the law `table`
  const SpringFunction* function = &spring_function(kind);

  // True for laws whose step is a passive one.
  bool curved() const { return row_of(kind).step >= SpringStep::kPassive; }
  SpringConstants constants() const { return {cubic, stiffening, &table}; }
  double force(double h) const { return function->force(h, constants()); }          // [m]
  double potential(double h) const { return function->potential(h, constants()); }  // [m2] its integral from 0
  double slope(double h) const { return function->slope(h, constants()); }          // [1]
  // (U(h1) - U(h0)) / (h1 - h0), without cancellation; it makes the step passive.
  double discrete_gradient(double h0, double h1) const { return function->mean_force(h0, h1, constants()); }
  double height_of(double force) const;  // [m] the inverse of force()
  // A height with its gradient (nx, ny, nz, h), as the force: what a relaxing arm stretches by.
  vec4 strained(vec4 x) const {
    if (!curved() || x.w == 0.0f) return x;
    const double h = static_cast<double>(x.w);
    return {static_cast<float>(slope(h)) * vec3(x), static_cast<float>(force(h))};
  }
};
RestoringLaw restoring_law(const Deformable& deformable);
// [1/m] `stiffening`, made non-zero: the exponential law divides by it.
double exponential_alpha(double stiffening);

// One passive step of m h'' = -b h' - k F(h) + f by the discrete gradient (energy identity dE = -T b vm^2 + f dh for
// any T). Backward Euler, which does not ring, for steps that are long for the spring (w T > 1.5).
HeightState step_restoring(const RestoringLaw& law, HeightState state, double mass, double damping, double stiffness,
                           double force, double dt);

// Quasi-linear viscoelasticity, m h'' = -b h' - F(h) - q, q' = r1 F'(h) h' - q/tau: half a relaxation at fixed h, a
// step of the springs F + q under the constant force r1 F(h0) - q0 (step_restoring), another half. No part makes
// energy: with z = F - q / r1 and the convex U* (F = U'), the arm stores r1 (U(h) + U*(z) - z h) >= 0 (methods.md 1.2).
struct SolidState {
  double height = 0.0, velocity = 0.0;  // [m] [m/s]
  double arm = 0.0;                     // [m] q
};
SolidState step_relaxing(const RestoringLaw& law, SolidState state, double mass, double damping, double arm_stiffness,
                         double half_decay, double force, double dt);

// A Deformable's parameters prepared for steps of T, k = 1.
struct Motion {
  double dt = 1e-3;      // [s]
  double mass = 1.0;     // [s2]  m/k
  double damping = 0.0;  // [s]   b/k
  RestoringLaw law;
  StepCoefficients linear;                       // of the linear law
  double arm_stiffness = 0;                      // [1]   k1/k, of a law with an arm
  double arm_time = 0;                           // [s]
  double arm_decay = 1.0;                        // e^(-T/tau)
  double arm_half = 1.0;                         // e^(-T/2tau)
  std::array<std::array<double, 3>, 3> solid{};  // of the standard linear solid
  SphereCurve sphere;                            // of a contact with a sphere; empty: Hertz
  bool nonlinear() const { return law.curved(); }
  bool arm() const { return has_arm(law.kind); }
};
Motion motion(const Deformable& deformable, double dt);
// [s] Its `damping`.
double free_damping(const Deformable& deformable);

// Rejects parameters for which the step fails: the sentence names the key, its value and its range.
Status check(const Deformable& deformable, const std::string& name);

}  // namespace pliant
