// A virtual wall behind a simulated device, one axis, closed loop: is it stable?
//
// The wall fills x < 0 and pushes towards +x with K depth + B depth', of samples; where it holds both ways, also for
// x > 0, it is the linear wall of wall_theory.h. A guard may change what leaves for the device.
#pragma once

#include <functional>
#include <vector>

#include "devices/simulated/axis.h"
#include "devices/simulated/wall_theory.h"

namespace pliant {

// What a tick wants of the device, given where it is and when: returns what may leave. All along the axis.
using ForceGuard = std::function<double(double position, double wanted, double time)>;  // [m], [N], [s]

struct WallLoop {
  WallPlant plant;          // the device; its numbers are both the simulation's and the theory's
  double lag = 0.0;         // [s] of the amplifier
  double force_step = 0.0;  // [N] a count
  double max_force = 0.0;   // [N] saturation; 0: none
  HandImpedance hand;       // who holds it
  double push = 0.0;        // [N] how hard the hand presses into the wall, or, where nobody holds it, a weight
  bool both_ways = false;   // the wall pulls too
  Wall wall;
};

// Where it begins.
struct WallStart {
  double depth = 0.0;  // [m] below the wall; < 0: outside
  double speed = 0.0;  // [m/s] into the wall
};

enum class Verdict { kStable, kCycle, kOff, kDivergent };  // from good to bad
const char* name_of(Verdict verdict);
inline Verdict worse(Verdict a, Verdict b) {
  return a > b ? a : b;
}

struct WallResult {
  Verdict verdict = Verdict::kStable;
  double amplitude = 0.0;  // [m] half of peak to peak at the end
  double speed = 0.0;      // [m/s] the largest at the end
  double work = 0.0;       // [J] that the motor did on the device, all in all
  double most_work = 0.0;  // [J] the largest that was
};

struct WallSample {
  double time = 0.0, position = 0.0, force = 0.0;  // [s], [m] true, [N] the motor's at the end of the period
};

// Runs `seconds`, and up to four times as long while it grows or falls slowly. `trace`: every period, if asked for.
//   stable: the last quarter's amplitude is below 0.98 of that of the quarter before, or nothing moves
//   limit cycle: it keeps within 2 % between quarters
//   off: it fell through the wall without force, because a guard took it away
//   divergent: it still grows at the end, or has left 1000 times the start, or 0.25 m
WallResult run_wall(const WallLoop& loop, const WallStart& start, double seconds, const ForceGuard& guard = {},
                    std::vector<WallSample>* trace = nullptr);

}  // namespace pliant
