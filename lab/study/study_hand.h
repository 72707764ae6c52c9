// The study `hand`: a simulated hand with a simulated device in it touches the demo levels, in a closed loop.
#pragma once

#include <string>
#include <vector>

#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"

namespace pliant {

struct HandSample {
  double time = 0.0, depth = 0.0, force = 0.0;  // [s], [m] under the surface, [N] the motor's
};

// A run of one level with one device in every probe's hand, which wants to follow the level's script.
struct HandRun {
  std::string level, profile;
  double delay = 0.0;               // [s] beside the profile's own
  bool guarded = true;              // false: what the probe feels goes to the device as it is. Simulated devices only
  std::vector<HandSample> samples;  // of the first probe
  double force = 0.0;               // [N] the largest
  double buzz = 0.0;  // [m] RMS of what is faster than about 20 Hz in the effector's motion in contact, the worst probe
  double late = 0.0;  // [m] the same of the last half second in contact: what grows is more there than before
  double flicker = 0.0;  // [N] RMS of how much a write differs from the mean of those before and after it: switching
  double work = 0.0;     // [J] of the motors on the hands, all probes
  double stiffest = 0.0, limit = 0.0;  // [N/m] of the level, and what the device renders stably
  bool stable() const;
  double softened() const;  // [1] how many times softer than the surface is what the hand feels
};

// At most this much of the effector's fast motion is friction's and the encoder's; a limit cycle is more.
inline constexpr double kQuietBuzz = 50e-6;  // [m]

// A force that is written by turns is felt as half of it, and moves the effector by micrometres only. More than counts
// of the encoder make.
inline constexpr double kQuietForce = 0.05;  // [N]

// `profile`: with keys after it, as in "omni,hand=finger". `stiffness` [N/m]: of every surface in the place of the
// level's; 0: as it is.
Result<HandRun> run_hand(const std::string& level, const std::string& profile, double delay, bool guarded,
                         double seconds, double stiffness = 0.0);
// hand_runs.svg and hand_runs.png: force and depth over time.
Status plot_hand_runs(OutputFolder& out, const std::vector<HandRun>& runs);

}  // namespace pliant
