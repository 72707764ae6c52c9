// Textures of the organ. Colour is a function of the point in space, so that the seams of the unfolded square are
// invisible.
#pragma once

#include "components/appearance.h"
#include "content/generate/lattice_sphere.h"

namespace pliant::generate {

// Mottled tissue colour, paler along the groove; size x size, sRGB.
Image organ_color(const LatticeSphere& sphere, std::uint32_t size);
// Fine bumps as a tangent-space normal map (+X along increasing u, +Z outwards).
Image organ_normals(const LatticeSphere& sphere, const Solid& solid, std::uint32_t size);

}  // namespace pliant::generate
