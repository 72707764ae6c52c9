// A point that goes over a body's collision mesh, from triangle to triangle.
#pragma once

#include <optional>

#include "systems/soft/body/body.h"

namespace pliant {

// Where `from` is after a way of `by` [m], which bends with the collision mesh as it is at the step's beginning.
// Nothing where the way leads over a border or an edge sharper than 60 degrees.
std::optional<SurfacePoint> walk(const Body& body, SurfacePoint from, dvec3 by);

}  // namespace pliant
