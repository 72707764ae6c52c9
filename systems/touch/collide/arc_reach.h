// How far the closed form of the distance along the surface holds (surface_distance.h), by comparison with the march.
// Once, at preparation.
#pragma once

#include <vector>

#include "components/mesh.h"

namespace pliant {

struct ObjectState;
struct TriangleSide;

// Per vertex: from a contact near it, the closed form serves every reach up to this. [m] Below `reach` it may be less
// than it could be.
std::vector<float> arc_reach(const Mesh& mesh, const std::vector<TriangleSide>& sides, const ObjectState& object,
                             double reach);

}  // namespace pliant
