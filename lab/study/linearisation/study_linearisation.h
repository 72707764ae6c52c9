// Accuracy and cost of a tool's 1 kHz force against the full solve (methods.md 2.6-2.8, 3.8). One level, one path of
// the device, two soft clocks:
//   (d) the full solve at the touch rate: its handle path and wrench are the reference;
//   the soft clock at the level's step. Each model is published one step late, as on a machine that needs the whole
// step to compute it, and evaluated at 1 kHz along the reference handle path:
//   (a) constant, (b) linear, (c) contacts solved again.
// In addition the same level with all clocks in lockstep and (c): cost of a touch tick and jumps at updates.
#pragma once

#include <string>
#include <vector>

#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"
#include "systems/soft/body/handle.h"

namespace pliant {

// The force on the handle in one tick, by each method. [N], [N m]
struct ForceSample {
  double time = 0.0;  // [s]
  Vector6 full = Vector6::Zero(), held = Vector6::Zero(), linear = Vector6::Zero(), contacts = Vector6::Zero();
};

struct MethodFigures {
  std::string name;
  double rms_N = 0.0, max_N = 0.0;                  // of the force error
  double rms_share = 0.0;                           // [1] relative to the RMS of the force beyond the tissue's weight
  double p50_us = 0.0, p99_us = 0.0, max_us = 0.0;  // per tick
};

struct LinearisationFigures {
  std::string level;
  double pace = 1.0;                                  // [1] of the script's pace
  double soft_step = 0.0, tick = 0.0, seconds = 0.0;  // [s]
  std::size_t tetrahedra = 0;
  int contacts = 0, modes = 0;         // maximum over the models
  Vector6 weight = Vector6::Zero();    // of the tissue
  double rms_N = 0.0, max_N = 0.0;     // [N] of the reference force beyond the weight
  double step_share = 0.0;             // [1] RMS error of the soft step at its own instants: bound for all models
  std::vector<MethodFigures> methods;  // constant, linear, contacts, full
  std::vector<ForceSample> samples;
  double touch_p50_us = 0.0, touch_p99_us = 0.0, touch_max_us = 0.0;  // tool_feedback, clocks in lockstep
  double jump_share = 0.0;     // [1] largest change in an update's tick or the next five, over that around it
  int updates = 0, jumps = 0;  // jumps: updates with a jump_share above 2
  int jumps_of_contacts = 0;   // of these, with a contact that closed, opened or changed between sticking and sliding
};

// Ends with an error when `interrupt` is requested.
Result<LinearisationFigures> measure_linearisation(const std::string& level, double pace, double seconds,
                                                   const Interrupt& interrupt);

// Writes STEM.svg and STEM.png: the force over time, by each method.
Status plot_linearisation(OutputFolder& out, const std::string& stem, const LinearisationFigures& figures);

}  // namespace pliant
