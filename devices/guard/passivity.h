// Energy at the servo's rate (methods.md 1.9): an observer adds up the work on the hand beside a tool's weight,
// and damping takes out what would go beyond what the hand gave. The touch tick has the same in
// systems/safety; this one sees every force that is written, those between two ticks among them. No slew limit comes
// behind it, so nothing has to stop early. What sampling itself gives (K T / 2) is not its business but
// stable_stiffness()'s.
#pragma once

#include "pliant/math.h"

namespace pliant {

// Tunables. Unit, usual value, and what changing it does.
inline constexpr double kGuardShare = 1e-3;     // [1] of the largest stored energy, which the hand may get beside
inline constexpr double kGuardFloor = 1e-6;     // [J] what quantised encoders may seem to give
inline constexpr double kGuardReserve = 1.05;   // [1] the next step is assumed this much longer than the last
inline constexpr double kGuardSlowHand = 0.01;  // [m/s] a slower hand is damped in proportion to its speed
inline constexpr double kGuardSlowTurn = 0.2;   // [rad/s] the same of what turns

// Of force and torque together: a push at a fingertip is both about the wrist.
struct EnergyAccount {
  double work = 0.0;    // [J] done on the hand so far
  double stored = 0.0;  // [J] the largest that -work has been
};

// One of the two: forces [N] with ways [m], or torques [N m] with angles [rad].
class PassivityDamper {
 public:
  // `wanted` without as much of its part along the motion as would give too much. `way`: of the hand since the last
  // call, against what it touches. `most`: the largest size. `slow`: [m] or [rad] per period.
  dvec3 damp(const EnergyAccount& account, dvec3 wanted, dvec3 weight, dvec3 way, double most, double slow);
  // After damp(): its way is accounted for, and this leaves, beside the weight.
  void book(EnergyAccount& account, dvec3 sent);
  void forget() { *this = {}; }

 private:
  dvec3 last_{0}, wanted_{0};  // beside the weight: written last, and wanted last
  double work_ = 0.0;          // [J] of the last way
};

}  // namespace pliant
