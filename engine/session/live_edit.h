// Changes between two ticks, sent to the touch clock of a session or of a window's run.
#pragma once

#include <variant>

#include "components/effect.h"
#include "components/world.h"
#include "engine/run/recording.h"
#include "systems/soft/body/tool_body.h"
#include "systems/touch/model/contact_energy.h"
#include "systems/touch/model/local_model.h"

namespace pliant {

// Parameters that change between ticks, all of one kind together, as sent to the touch clock.
struct SurfaceSetting {
  DeformableParameters now;
  Motion motion;
  ShareKernel kernel;
};
struct ProbeSetting {
  double radius = 0.0;  // [m]
};
struct WeightSetting {
  dvec3 weight{0};  // [N] of a tool without gravity compensation
};
// Actions of the owner on hands and objects, other than parameters.
struct EventEdit {
  EventKind kind = EventKind::kSet;  // kSet, and the soft clock's: only stamped here
  double value = 0.0;
  dvec3 force{0}, torque{0};  // for kHandForce; for kPlace, force is the position [m]
  dquat rotation{1, 0, 0, 0};
};
// A change sent to the touch clock, which reports the tick in which it was applied.
struct Edit {
  Entity entity;
  std::variant<EventEdit, SurfaceSetting, DeviceParameters, ProbeSetting, CouplingSetting, WeightSetting, EffectSetting>
      now;
  std::uint32_t number = 0;  // of its event in the current recording; 0: none
};

// Does not allocate.
void apply_edit(World& world, const Edit& edit);

}  // namespace pliant
