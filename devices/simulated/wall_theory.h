// Closed-form results for a virtual wall, stiffness K and damping B, sampled with period T on a device of mass m,
// damping b and Coulomb friction c, with encoder resolution D. The force has a zero-order hold and a transport delay d.
#pragma once

#include "pliant/math.h"

namespace pliant {

struct WallPlant {
  double mass = 0.1;      // m [kg]
  double damping = 0.1;   // b [N s/m]
  double friction = 0.0;  // c [N]
  double encoder = 0.0;   // D [m]
  double period = 1e-3;   // T [s]
  double delay = 0.0;     // d [s]
};
struct Wall {
  double stiffness = 0.0;  // K [N/m]
  double damping = 0.0;    // B [N s/m], of the backward difference of samples
};

// Exact, of the bilateral wall without friction and counts: every root of the characteristic polynomial
//   (z-1)(z-a) z^(k+1) T + [K T z + B (z-1)] [z((z-a) g1 + p h1) + (z-a) g0 + p h0] = 0
// lies within |z| < `radius` (Jury's test). a = exp(-bT/m), p = (m/b)(1-a); g, h: position and velocity that one newton
// leaves behind, of the part of a period before (0) and after (1) a command arrives; d = (k + fraction) T.
bool linearly_stable(const WallPlant& plant, const Wall& wall, double radius = 1.0);

// The smallest unstable K; 0: no stiffness is stable. [N/m]
double stability_limit(const WallPlant& plant, double wall_damping);

// Passive for every hand: b > KT/2 + |B| (Colgate and Schenkel 1997); a delay d adds K d (Diolaiti et al. 2006).
bool passive(const WallPlant& plant, const Wall& wall);
double passivity_limit(const WallPlant& plant, double wall_damping);  // [N/m]; 0: none

// Quantisation generates K D/2 |v| and friction dissipates c |v| (Abbott and Okamura 2005, Diolaiti et al. 2006): K <=
// 2c/D. [N/m]
double quantisation_limit(const WallPlant& plant);

// Diolaiti's power balance at speed v, for B = 0. Hold and delay generate K(T/2 + d) v^2, quantisation K D/2 v; the
// device dissipates b v^2 + c v. With s = (K D/2 - c) / (b - K(T/2 + d)), a speed:
enum class WallRegime {
  kDissipative,  // at every speed
  kCycle,        // above s: it decays to a limit cycle slower than s
  kLocal,        // below s: small motion comes to rest, faster motion may grow
  kUnstable      // at no speed
};
struct WallBalance {
  WallRegime regime = WallRegime::kDissipative;
  double speed = 0.0;  // s [m/s], of kCycle and kLocal
};
WallBalance balance(const WallPlant& plant, double stiffness);
const char* name_of(WallRegime regime);

}  // namespace pliant
