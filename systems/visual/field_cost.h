// Cost of a level's fields per displayed frame on the CPU and on the GPU, measured on this machine. `--field auto`
// chooses by it.
#pragma once

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

struct FieldCost {
  double processor_us = 0.0;  // [us] per frame: the zones that one contact reaches, for every touch tick of the frame
  double gpu_us = 0.0;        // [us] per frame: the whole mesh once, two sources
};

// For the largest deformable whose field the GPU can evaluate alone (has_closed_form). Needs a current OpenGL 4.5
// context; call before the touch clock runs. The error explains why there is no choice.
Result<FieldCost> measure_field_cost(const World& world, double frame_rate_hz);

}  // namespace pliant
