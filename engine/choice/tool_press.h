// A tool by itself, pressed on a fixed plate below it and drawn along it, by a script: what the hand that holds it
// feels, by the touch clock beside a soft clock of the level's step, and by short soft steps: at the touch rate, or as
// near to it as can be measured in a minute.
#pragma once

#include <string>
#include <vector>

#include "components/world.h"
#include "content/level/level.h"
#include "engine/choice/choice_parts.h"
#include "runtime/result.h"
#include "systems/soft/body/handle.h"

namespace pliant {

class ToolPress {
 public:
  // With the level's soft step and touch rate.
  static Result<ToolPress> make(const Level& level, std::size_t node);

  // [N], [N m] on the hand at every tick (of the truth: step), of the coupling alone.
  struct Felt {
    std::vector<Vector6> wrench;
    double ms = 0.0;              // of a tick's tool_feedback, median; of the truth: of a soft step, mean
    int contacts = 0, modes = 0;  // most in a model
    double left_out = 0.0;        // [1] of the contacts' static flexibility: what the modes leave out, largest
  };
  // Short soft steps: the handle follows the hand by its coupling in the step itself. A wrench a step.
  Result<Felt> truth(ChoiceProgress& progress);
  // Both clocks. Models come one step late, as from a machine that needs the whole step for them.
  Result<Felt> touched(ToolForce force);

  double depth() const { return depth_; }  // [m] that the hand goes beyond the touch
  // Why neither can be asked for, with the cure; "": they can.
  const std::string& unmeasured() const { return unmeasured_; }
  std::size_t truth_ticks() const { return stride_; }                         // of a step of the truth
  double truth_step() const { return static_cast<double>(stride_) * tick_; }  // [s]

 private:
  Status prepare(ToolForce force);

  World world_;
  Entity tool_;
  double tick_ = 1e-3, depth_ = 0.0;
  std::size_t ticks_ = 0, length_ = 1, stride_ = 1;  // of the script, of a soft step, of a step of the truth
  std::string unmeasured_;
};

}  // namespace pliant
