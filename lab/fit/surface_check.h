// Evaluates the engine at places that the fit has not used: a session with the fitted surface and a point probe.
#pragma once

#include <vector>

#include "components/deformable.h"
#include "content/level/level.h"
#include "lab/fit/surface_fit.h"

namespace pliant {

// `primitives`: in the object frame, with painted stiffness. `built`: the mesh that the engine builds from them.
// Presses each place to its own depths. Returns the force along the normal before the safety layer, and the heights of
// the drawn surface at the place's sample points.
Result<std::vector<std::vector<PressedTissue>>> press_surface(const std::vector<Primitive>& primitives,
                                                              const DeformableParameters& surface, const Mesh& built,
                                                              const std::vector<PressedPlace>& places);

}  // namespace pliant
