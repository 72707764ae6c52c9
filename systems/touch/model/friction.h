// Bristle friction, implicit and in closed form (methods.md 1.6), with static and sliding limits for stick-slip. f acts
// on the surface, -f on the probe.
#pragma once

#include "components/math.h"

namespace pliant {

// Tunables. The bristle has the normal stiffness of the surface. It is damped over about two ticks of 1 kHz, so that it
// neither rings nor feels sticky.
inline constexpr double kBristleStiffness = 1.0;     // [1] times the local normal stiffness
inline constexpr double kBristleDampingTime = 2e-3;  // [s] B = K * this

// mu(v) = mu_d + (mu_s - mu_d) exp(-(v / v_s)^2) + b v (Stribeck; Armstrong-Helouvry 1994, eq. 6), v_s = 0: mu_d + b v.
struct SlidingFriction {
  double static_value = 0.0, sliding_value = 0.0;  // [1]   mu_s, mu_d
  double stribeck = 0.0;                           // [m/s] v_s
  double viscous = 0.0;                            // [s/m] b
  double at(double speed) const;                   // [1]
  double slope(double speed) const;                // [s/m] d mu / dv
};

struct Bristle {
  dvec3 deflection{0};  // [m] e, tangential
  bool sliding = false;
};

// One step of T under tangential velocity v [m/s]; returns f [N]. K [N/m], B [N s/m], limits [N], the static one at
// least the sliding one. The slip T v - de has the direction of f, whatever the limits were before: over any walk the
// work of f is at least what the bristle stores, 1/2 K e^2.
dvec3 step_bristle(Bristle& bristle, dvec3 velocity, double stiffness, double damping, double static_limit,
                   double sliding_limit, double dt);

}  // namespace pliant
