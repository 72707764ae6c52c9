// The study `walls`: stability of a sampled virtual wall, measured over stiffness, damping and delay, against closed
// forms, with and without the guard of the devices.
#pragma once

#include <string>
#include <vector>

#include "devices/simulated/loop.h"
#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"

namespace pliant {

// The simulated system: the linear wall of the theory, or a device with friction and encoder counts in a light hand.
enum class WallModel { kLinear, kDevice, kGuarded };
const char* name_of(WallModel model);

struct WallCell {
  WallModel model = WallModel::kLinear;
  double delay = 0.0;  // [s]
  Wall wall;
  WallResult result;          // worst over all starts
  bool fades = false;         // a cycle below one count: the guard fades a still hand's force and restores it
                              // (docs/devices/safety.md, frozen)
  bool linear_stable = true;  // by the characteristic polynomial
  bool marginal = false;      // a root within kMarginal of the unit circle: neither verdict is used
  bool passive = false;       // Colgate's condition, with delay
};
inline constexpr double kMarginal = 1e-3;  // [1]

// A limit cycle due to encoder counts alone, against the largest speed by Diolaiti's energy balance.
struct WallCycle {
  double stiffness = 0.0, predicted = 0.0, speed = 0.0, amplitude = 0.0;  // [N/m], [m/s], [m/s], [m]
};

struct WallFigures {
  std::string profile;
  WallPlant plant;            // without delay
  double hand_damping = 0.0;  // [N s/m] of the light hand
  std::vector<double> delays, stiffnesses, dampings;
  std::vector<double> limits;   // [N/m] per delay: the guard's limit
  std::vector<WallCell> cells;  // by model, delay, damping, and stiffness (fastest)
  std::vector<WallCycle> cycles;
  std::size_t compared = 0, agree = 0;                                      // of the linear wall
  std::size_t count(WallModel model, double delay, Verdict verdict) const;  // without cells whose force fades
  std::size_t fading(WallModel model, double delay) const;
};

// `many` stiffnesses. Deterministic for any number of threads.
Result<WallFigures> measure_walls(std::size_t stiffnesses, std::size_t dampings, double seconds,
                                  const Interrupt& interrupt);
// Writes walls.svg and walls.png.
Status plot_walls(OutputFolder& out, const WallFigures& figures, const std::vector<std::string>& sentences);

}  // namespace pliant
