// The study `hand`: a simulated hand holding a simulated device touches the demo levels, in a closed loop.
#pragma once

#include <string>
#include <vector>

#include "lab/console/exit.h"
#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"

namespace pliant {

struct HandSample {
  double time = 0.0, depth = 0.0, force = 0.0;  // [s], [m] under the surface, [N] of the motor
};

// A run of one level with the same device for every probe. The hand tries to follow the level's script.
struct HandRun {
  std::string level, profile;
  double delay = 0.0;               // [s] in addition to the profile's
  bool guarded = true;              // false: the raw force of the probe is sent to the device. Simulated devices only
  std::vector<HandSample> samples;  // of the first probe
  double force = 0.0;               // [N] largest
  double buzz = 0.0;                // [m] RMS of the effector's motion in contact above about 20 Hz, of the worst probe
  double late = 0.0;                // [m] the same in the last half second of contact: larger if the motion grows
  double flicker = 0.0;             // [N] RMS difference of a write from the mean of its two neighbours: switching
  double work = 0.0;                // [J] of the motors on the hands, all probes
  double stiffest = 0.0, limit = 0.0;  // [N/m] of the level, and the device's stable limit
  bool stable() const;
  double softened() const;  // [1] stiffness of the surface over the rendered stiffness
};

// Fast motion of the effector up to this value is due to friction and the encoder; a limit cycle exceeds it.
inline constexpr double kQuietBuzz = 50e-6;  // [m]

// A force that alternates between writes acts as half of it and moves the effector by micrometres only. The threshold
// lies above the noise of encoder counts.
inline constexpr double kQuietForce = 0.05;  // [N]

// `profile`: with keys after it, as in "omni,hand=finger". `stiffness` [N/m]: replaces that of every surface; 0: the
// level's.
Result<HandRun> run_hand(const std::string& level, const std::string& profile, double delay, bool guarded,
                         double seconds, double stiffness = 0.0);
// Writes hand_runs.svg and hand_runs.png: force and depth over time.
Status plot_hand_runs(OutputFolder& out, const std::vector<HandRun>& runs);

}  // namespace pliant
