// Energy at the servo's rate (methods.md 1.9): an observer adds up the work on the hand beside a tool's weight,
// and damping takes out what would go beyond what the hand gave. The touch tick has the same in
// systems/safety; this one sees every force that is written, those between two ticks among them. No slew limit comes
// behind it, so nothing has to stop early. What sampling itself gives (K T / 2) is not its business but
// stable_stiffness()'s.
//
// Where the account is spent, the force is that of a spring (kGuardSpringShare) which holds what is left of it, and it
// comes back as that spring is pressed. A force that only the way's sign switched, zero outwards and whole inwards,
// would switch in every period for as long as a hand rests there: measured, 500 of 1,000 writes a second were zero.
//
// A share of the wanted force that rises (ramp, fade, a limit that is raised) pushes a hand that rests in what it
// touches, and does work that the hand has not given to the lower force. What the hand would have given to the whole
// one is credited for that: StoredInWish.
#pragma once

#include "pliant/math.h"

namespace pliant {

// Tunables. Unit, usual value, and what changing it does.
inline constexpr double kGuardShare = 1e-3;       // [1] of the largest stored energy, which the hand may get beside
inline constexpr double kGuardFloor = 1e-6;       // [J] what quantised encoders may seem to give
inline constexpr double kGuardReserve = 1.05;     // [1] the next step is assumed this much longer than the last
inline constexpr double kGuardSlowHand = 0.01;    // [m/s] a slower hand is damped in proportion to its speed
inline constexpr double kGuardSlowTurn = 0.2;     // [rad/s] the same of what turns
inline constexpr double kGuardSpringShare = 1.5;  // [1] of what is touched: the spring by which a spent account lets go
inline constexpr double kGuardSpring = 2000.0;    // [N/m] where its stiffness is not known; softer: it lets go earlier
inline constexpr double kGuardTurnSpring = 5.0;   // [N m/rad] the same at a lever of 50 mm

// Of force and torque together: a push at a fingertip is both about the wrist.
struct EnergyAccount {
  double work = 0.0;    // [J] done on the hand so far
  double stored = 0.0;  // [J] the largest that -work has been
};

// One of the two: forces [N] with ways [m], or torques [N m] with angles [rad].
class PassivityDamper {
 public:
  // `wanted` without as much as would give too much. `way`: of the hand since the last call, against what it touches.
  // `most`: the largest size. `slow`: [m] or [rad] per period. `stiffness`: of what is
  // touched, along the force; 0: not known. `spring`: where it is not.
  dvec3 damp(const EnergyAccount& account, dvec3 wanted, dvec3 weight, dvec3 way, double most, double slow,
             double stiffness, double spring);
  // After damp(): its way is accounted for, and this leaves, beside the weight.
  void book(EnergyAccount& account, dvec3 sent);
  void forget() { *this = {}; }

 private:
  dvec3 held_by_spring(dvec3 wanted, dvec3 moved, double budget, double spring);

  dvec3 last_{0}, wanted_{0};  // beside the weight: written last, and wanted last
  double held_ = 0.0;          // [N] of the wanted force that is kept back
  double work_ = 0.0;          // [J] of the last way
};

// [J] What the hand would have stored in the wanted force, had all of it been written. Begins anew where nothing is
// wanted.
class StoredInWish {
 public:
  // `wanted` [N] beside the weight, whole, at most what may ever leave. `stiffness` [N/m] of it along itself; 0: not
  // known.
  void follow(dvec3 wanted, dvec3 moved, double stiffness);
  void raise(double energy) { given_ += energy; }  // [J] as the wanted force is cut less
  double energy() const { return energy_; }
  void forget() { *this = {}; }

 private:
  dvec3 last_{0};
  double given_ = 0.0, energy_ = 0.0;  // [J] by the way gone; and at least by the stiffness
};

}  // namespace pliant
