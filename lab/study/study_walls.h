// The study `walls`: where a sampled virtual wall is stable, measured, over stiffness, damping and delay; against what
// is known in closed form; with and without the guard that stands in front of every device.
#pragma once

#include <string>
#include <vector>

#include "devices/simulated/loop.h"
#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"

namespace pliant {

// What is simulated: the linear wall of the theory, and a device of friction and counts in a light hand.
enum class WallModel { kLinear, kDevice, kGuarded };
const char* name_of(WallModel model);

struct WallCell {
  WallModel model = WallModel::kLinear;
  double delay = 0.0;  // [s]
  Wall wall;
  WallResult result;          // the worst of all starts
  bool fades = false;         // a cycle of less than a count: the guard lets the force of a hand that holds still fade,
                              // and the hand has it back (docs/devices/safety.md, frozen)
  bool linear_stable = true;  // by the characteristic polynomial
  bool marginal = false;      // a root within kMarginal of the unit circle: neither is believed
  bool passive = false;       // Colgate's condition, with delay
};
inline constexpr double kMarginal = 1e-3;  // [1]

// A limit cycle of counts alone, against the largest speed that Diolaiti's balance allows.
struct WallCycle {
  double stiffness = 0.0, predicted = 0.0, speed = 0.0, amplitude = 0.0;  // [N/m], [m/s], [m/s], [m]
};

struct WallFigures {
  std::string profile;
  WallPlant plant;            // without delay
  double hand_damping = 0.0;  // [N s/m] of the light hand
  std::vector<double> delays, stiffnesses, dampings;
  std::vector<double> limits;   // [N/m] of each delay: what the guard lets the device render
  std::vector<WallCell> cells;  // delay by delay of each model, damping by damping, K fastest
  std::vector<WallCycle> cycles;
  std::size_t compared = 0, agree = 0;                                      // of the linear wall
  std::size_t count(WallModel model, double delay, Verdict verdict) const;  // without those whose force fades
  std::size_t fading(WallModel model, double delay) const;
};

// `many` stiffnesses. Deterministic, whatever the number of threads.
Result<WallFigures> measure_walls(std::size_t stiffnesses, std::size_t dampings, double seconds,
                                  const Interrupt& interrupt);
// walls.svg and walls.png.
Status plot_walls(OutputFolder& out, const WallFigures& figures, const std::vector<std::string>& sentences);

}  // namespace pliant
