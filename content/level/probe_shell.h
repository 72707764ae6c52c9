// A probe's surface as a mesh, for where it meets soft and rigid bodies: a sphere or a capsule at every tip.
#pragma once

#include "components/mesh.h"
#include "components/probe.h"
#include "runtime/result.h"

namespace pliant {

// [m] What a point is among bodies: two surfaces meet, and a point has none.
inline constexpr double kPointShell = 5e-4;

// Probe frame, outward normals, closed. Vertices lie on the surface, faces up to 2 % of the radius below it.
Result<Mesh> probe_shell(const Probe& probe);

}  // namespace pliant
