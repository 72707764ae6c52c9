// Instruments as closed meshes with few triangles.
#pragma once

#include "content/author/surface_nets.h"
#include "content/generate/solid.h"

namespace pliant::generate {

// A palpation stylus, 0.15 m long: a grip, a shaft bent by 20 degrees near its end, a ball of radius kStylusTip at the
// tip. The origin is in the grip; the shaft runs along -Y and bends towards -Z. [m]
Net stylus();
inline constexpr double kStylusTip = 0.0045;  // [m] radius of the ball
dvec3 stylus_tip();                           // [m] the ball's centre

// A box with these half edges, 12 triangles. [m]
Net box_mesh(dvec3 half);

}  // namespace pliant::generate
