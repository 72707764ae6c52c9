// Moves a point over a body's collision mesh, from triangle to triangle.
#pragma once

#include <optional>

#include "systems/soft/body/body.h"

namespace pliant {

// `from` displaced by `by` [m], which bends with the collision mesh at the beginning of the step. Empty if the path
// crosses a border or an edge sharper than 60 degrees.
std::optional<SurfacePoint> walk(const Body& body, SurfacePoint from, dvec3 by);

}  // namespace pliant
