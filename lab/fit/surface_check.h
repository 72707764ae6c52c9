// What the engine itself does at places that a fit has not seen: a session with the fitted surface and a point probe.
#pragma once

#include <vector>

#include "components/deformable.h"
#include "content/level/level.h"
#include "lab/fit/surface_fit.h"

namespace pliant {

// `primitives` in the object frame, painted; `built`: the mesh that the engine makes of them. At each place presses to
// the depths of its own: the force along the place's normal before the safety layer, and the drawn surface's heights at
// the points that it was seen at.
Result<std::vector<std::vector<PressedTissue>>> press_surface(const std::vector<Primitive>& primitives,
                                                              const DeformableParameters& surface, const Mesh& built,
                                                              const std::vector<PressedPlace>& places);

}  // namespace pliant
