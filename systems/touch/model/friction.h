// Bristle friction, implicit and in closed form (methods.md 1.6), with static and sliding limits for stick-slip. f acts
// on the surface, -f on the probe.
#pragma once

#include "components/math.h"

namespace pliant {

// Tunables. The bristle has the normal stiffness of the surface. It is damped over about two ticks of 1 kHz, so that it
// neither rings nor feels sticky.
inline constexpr double kBristleStiffness = 1.0;     // [1] times the local normal stiffness
inline constexpr double kBristleDampingTime = 2e-3;  // [s] B = K * this

struct Bristle {
  dvec3 deflection{0};  // [m] e, tangential
  bool sliding = false;
};

// One step of T under tangential velocity v [m/s]; returns f [N]. K [N/m], B [N s/m], limits [N].
dvec3 step_bristle(Bristle& bristle, dvec3 velocity, double stiffness, double damping, double static_limit,
                   double sliding_limit, double dt);

}  // namespace pliant
