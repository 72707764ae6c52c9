// A probe's surface mesh for contact with soft and rigid bodies: its spheres and capsules (components/probe_shape.h).
#pragma once

#include "components/mesh.h"
#include "components/probe.h"
#include "runtime/result.h"

namespace pliant {

// [m] Radius that a point probe gets for contact with bodies, which is between two surfaces.
inline constexpr double kPointShell = 5e-4;

// Probe frame, outward normals, closed. Vertices lie on the surface; faces lie up to 2 % of the radius below it.
Result<Mesh> probe_shell(const Probe& probe);

}  // namespace pliant
