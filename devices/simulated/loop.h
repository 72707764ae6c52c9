// A virtual wall with a simulated device, one axis, closed loop, to test its stability.
//
// The wall fills x < 0 and pushes towards +x with K depth + B depth', of samples. A bilateral wall also acts for x > 0:
// the linear wall of wall_theory.h. A guard may limit the rendered force.
#pragma once

#include <functional>
#include <vector>

#include "devices/simulated/axis.h"
#include "devices/simulated/wall_theory.h"

namespace pliant {

// Limits a tick's wanted force, given the device's position and the time; returns the rendered force. All along the
// axis.
using ForceGuard = std::function<double(double position, double wanted, double time)>;  // [m], [N], [s]

struct WallLoop {
  WallPlant plant;          // the device, for simulation and theory
  double lag = 0.0;         // [s] of the amplifier
  double force_step = 0.0;  // [N] per count
  double max_force = 0.0;   // [N] saturation; 0: none
  HandImpedance hand;       // who holds it
  double push = 0.0;        // [N] force of the hand into the wall; without a hand, a weight
  bool both_ways = false;   // the wall pulls too
  Wall wall;
};

// Initial conditions.
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
  double amplitude = 0.0;  // [m] half of peak to peak, at the end
  double speed = 0.0;      // [m/s] the largest, at the end
  double work = 0.0;       // [J] total work of the motor on the device
  double most_work = 0.0;  // [J] its maximum
};

struct WallSample {
  double time = 0.0, position = 0.0, force = 0.0;  // [s]; [m] true; [N] motor force at the end of the period
};

// Runs `seconds`, and up to four times as long while it grows or decays slowly. `trace`: every period, if requested.
//   stable: the last quarter's amplitude is below 0.98 of the previous quarter's, or nothing moves
//   limit cycle: the amplitude stays within 2 % between quarters
//   off: it fell through the wall without force, because a guard removed it
//   divergent: it still grows at the end, or has left 1000 times the start, or 0.25 m
WallResult run_wall(const WallLoop& loop, const WallStart& start, double seconds, const ForceGuard& guard = {},
                    std::vector<WallSample>* trace = nullptr);

}  // namespace pliant
