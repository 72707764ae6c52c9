// A tool as the touch clock has it, and the two buffers between its clocks. Writer: the touch clock, but for `model`.
#pragma once

#include <memory>
#include <vector>

#include "components/world.h"
#include "systems/device/safety.h"
#include "systems/tool/handle_model.h"

namespace pliant {

// How the 1 kHz force is made. In rising order of truth and cost.
enum class ToolForce : std::uint8_t {
  kHeld,      // the last soft step's force, unchanged
  kLinear,    // LinearModel
  kContacts,  // CondensedContacts solved every tick; kLinear when late
};

struct ToolTouchState {
  Entity entity;                    // has a Handle6 and a SoftBody
  Entity device = kNoEntity;        // has a HapticDevice; kNoEntity: nobody moves the tool
  TripleBuffer<ToolInput> input;    // touch -> soft
  TripleBuffer<HandleModel> model;  // soft -> touch
  SafetyState safety;
};

// World::tools. Sized by prepare_tools.
struct ToolTouch {
  std::vector<std::unique_ptr<ToolTouchState>> tools;
};

}  // namespace pliant
