// What a level's fields would cost per displayed frame on the processor and on the GPU, measured on this machine: what
// `--field auto` chooses by.
#pragma once

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

struct FieldCost {
  double processor_us = 0.0;  // [us] per frame: the zones that one contact reaches, for every touch tick of the frame
  double gpu_us = 0.0;        // [us] per frame: the whole mesh once, two sources
};

// Of the largest deformable whose field the GPU can evaluate alone (has_closed_form). Needs a current OpenGL 4.5
// context; call before the touch clock runs. The error says why there is nothing to choose.
Result<FieldCost> measure_field_cost(const World& world, double frame_rate_hz);

}  // namespace pliant
