// How near the 1 kHz force of a tool comes to the full solve, and what it costs (methods.md 2.6-2.8, 3.8). One level,
// one path of the device, two soft clocks:
//   (d) the full solve at the touch rate: its handle's path and wrench are the truth;
//   the soft clock at the level's own step, each of its models published one step late, as a machine that needs the
//   whole step for it would, and asked at 1 kHz for the wrench along the true handle's path:
//   (a) held, (b) linear, (c) contacts solved again.
// Besides, the same level with all clocks in lockstep and (c) at work: cost of a touch tick and jumps at updates.
#pragma once

#include <string>
#include <vector>

#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"
#include "systems/soft/body/handle.h"

namespace pliant {

// The force on the handle in one tick, by each way. [N], [N m]
struct ForceSample {
  double time = 0.0;  // [s]
  Vector6 full = Vector6::Zero(), held = Vector6::Zero(), linear = Vector6::Zero(), contacts = Vector6::Zero();
};

struct MethodFigures {
  std::string name;
  double rms_N = 0.0, max_N = 0.0;                  // of the force's error
  double rms_share = 0.0;                           // [1] of the RMS of what is felt beyond the tissue's weight
  double p50_us = 0.0, p99_us = 0.0, max_us = 0.0;  // cost of a tick
};

struct LinearisationFigures {
  std::string level;
  double pace = 1.0;                                  // [1] of the script's own
  double soft_step = 0.0, tick = 0.0, seconds = 0.0;  // [s]
  std::size_t tetrahedra = 0;
  int contacts = 0, modes = 0;         // most in any model
  Vector6 weight = Vector6::Zero();    // of the tissue
  double rms_N = 0.0, max_N = 0.0;     // of the true force beyond the weight
  double step_share = 0.0;             // [1] RMS error of the soft step at its own instants: what no model can undo
  std::vector<MethodFigures> methods;  // held, linear, contacts, full
  std::vector<ForceSample> samples;
  double touch_p50_us = 0.0, touch_p99_us = 0.0, touch_max_us = 0.0;  // tool_feedback, clocks together
  double jump_share = 0.0;     // [1] largest change in an update's tick or the next five, over the slope around it
  int updates = 0, jumps = 0;  // jumps: those where it is above 2
  int jumps_of_contacts = 0;   // of these, as a contact touched, let go or changed between sticking and sliding
};

// Ends with an error when `interrupt` is requested.
Result<LinearisationFigures> measure_linearisation(const std::string& level, double pace, double seconds,
                                                   const Interrupt& interrupt);

// STEM.svg and STEM.png: the force over time, by each way.
Status plot_linearisation(OutputFolder& out, const std::string& stem, const LinearisationFigures& figures);

}  // namespace pliant
