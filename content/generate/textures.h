// Pictures of the organ's surface: what it looks like is a function of the point in space, so that the texture has no
// visible seam wherever the unfolded square is cut.
#pragma once

#include "components/appearance.h"
#include "content/generate/lattice_sphere.h"

namespace pliant::generate {

// Mottled flesh with paler tissue along the groove; size x size, sRGB.
Image organ_color(const LatticeSphere& sphere, std::uint32_t size);
// Fine bumps as a tangent-space normal map (+X along growing u, +Z out).
Image organ_normals(const LatticeSphere& sphere, const Solid& solid, std::uint32_t size);

}  // namespace pliant::generate
