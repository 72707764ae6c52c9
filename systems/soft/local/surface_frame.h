// A part of a body's surface as a rigid body: from its rest shape to the world and back.
#pragma once

#include "systems/soft/body/body.h"

namespace pliant {

struct SurfaceFrame {
  dmat3 turn{1};
  dvec3 rest{0}, now{0};  // [m] the same point
  dvec3 to_rest(dvec3 x) const { return (x - now) * turn + rest; }
  dvec3 to_world(dvec3 x) const { return turn * (x - rest) + now; }
};

// At a triangle of the collision mesh: exact for a rigid body.
SurfaceFrame frame_of_triangle(const Body& body, std::uint32_t triangle);

}  // namespace pliant
