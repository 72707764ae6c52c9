// What the engine itself does at places that a fit has not seen: a session with the fitted surface and a point probe.
#pragma once

#include <vector>

#include "components/deformable.h"
#include "content/level/level.h"
#include "player/fit/tissue_press.h"

namespace pliant {

// `primitives` in the object frame, painted. At each place a press to each of these depths [m], ascending: the force
// along the place's normal before the safety layer, and the heights of the surface's vertices.
Result<std::vector<std::vector<PressedTissue>>> press_surface(const std::vector<Primitive>& primitives,
                                                              const DeformableParameters& surface,
                                                              const std::vector<PressPlace>& places,
                                                              const std::vector<std::vector<double>>& depths);

}  // namespace pliant
