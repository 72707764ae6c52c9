// An isolated tool, pressed by a script on a fixed plate below it and dragged along it. Its hand force is computed by
// the touch clock with a soft clock at the level's step, and by short soft steps as reference: at the touch rate, or
// the nearest rate that can be measured in a minute.
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

  // [N], [N m] on the hand in every tick (of the reference: in every step), of the coupling alone.
  struct Felt {
    std::vector<Vector6> wrench;
    double ms = 0.0;              // of a tick's tool_feedback, median; of the reference: of a soft step, mean
    int contacts = 0, modes = 0;  // maximum over the models
    double left_out = 0.0;        // [1] largest share of the contacts' static flexibility that the modes leave out
  };
  // Reference with short soft steps, in which the coupling moves the handle with the hand. One wrench per step.
  Result<Felt> truth(ChoiceProgress& progress);
  // Both clocks. Models arrive one step late, as on a machine that needs the whole step to compute them.
  Result<Felt> touched(ToolForce force);

  double depth() const { return depth_; }  // [m] by which the hand moves beyond first contact
  // The reason why neither can be measured, with the remedy; empty: they can.
  const std::string& unmeasured() const { return unmeasured_; }
  std::size_t truth_ticks() const { return stride_; }                         // of a step of the reference
  double truth_step() const { return static_cast<double>(stride_) * tick_; }  // [s]

 private:
  Status prepare(ToolForce force);

  World world_;
  Entity tool_;
  double tick_ = 1e-3, depth_ = 0.0;
  std::size_t ticks_ = 0, length_ = 1, stride_ = 1;  // of the script, of a soft step, of a step of the reference
  std::string unmeasured_;
};

}  // namespace pliant
