// The passive step of the non-linear laws (step_restoring, methods.md 1.2) for the vertices of a zone at once.
#pragma once

#include "components/math.h"
#include "systems/touch/model/painted_motion.h"

namespace pliant {

struct ZoneTargets;

// Heights by the passive step. The normal correction is the gradient of the height, so it obeys the law linearised
// there (implicit midpoint with the slope at the middle). `targets`: the spring forces of these shapes act
// (Response::kLag); null: none. `painted` may be empty. state, rate and arm: (nx, ny, nz, h) of kZoneSize vertices.
// With an arm it is step_relaxing's; null: the law has none.
void step_nonlinear(const Motion& motion, const PaintedMotion& painted, std::uint32_t zone, vec4* state, vec4* rate,
                    vec4* arm, const ZoneTargets* targets);

}  // namespace pliant
