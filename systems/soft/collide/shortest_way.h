// Separation direction of two bodies that begin inside each other.
#pragma once

#include <optional>

#include "systems/soft/collide/collision_mesh.h"

namespace pliant {

// [1] unit, world: the direction along which body a leaves body b by the shortest translation, by separating axes
// (Gottschalk, Lin & Manocha 1996, section 5). Axes: normals of both, and cross products of their edges if those are
// few. None if they are apart, or one is not convex: then every vertex goes in its nearest direction.
std::optional<dvec3> shortest_way(const CollisionMesh& a, const CollisionMesh& b);

}  // namespace pliant
