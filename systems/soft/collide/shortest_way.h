// Which way two bodies that begin inside each other are pushed apart.
#pragma once

#include <optional>

#include "systems/soft/collide/collision_mesh.h"

namespace pliant {

// [1] unit, world: the direction along which body a leaves body b by the shortest translation, by separating axes
// (Gottschalk, Lin & Manocha 1996, section 5): normals of both, and cross products of their edges where those are few.
// None where they are apart, or where one of them is not convex: then every vertex goes the way that is nearest to it.
std::optional<dvec3> shortest_way(const CollisionMesh& a, const CollisionMesh& b);

}  // namespace pliant
