// Textures of the organ, the ball and the pad. Colour is a function of the point in space, so that the seams of the
// unfolded square are invisible.
#pragma once

#include "components/appearance.h"
#include "content/generate/lattice_sphere.h"

namespace pliant::generate {

// Mottled tissue colour, paler along the groove; size x size, sRGB.
Image organ_color(const LatticeSphere& sphere, std::uint32_t size);
// Fine bumps as a tangent-space normal map (+X along increasing u, +Z outwards).
Image organ_normals(const LatticeSphere& sphere, const Solid& solid, std::uint32_t size);
// Clay with pale ridges, the first one green; rings of latitude.
Image ball_color(const LatticeSphere& sphere, std::uint32_t size);
// Flushed skin with faint veins.
Image skin_color(const LatticeSphere& sphere, std::uint32_t size);

// The pad's share of hardness at (x, z) [m], 1 over the hard spot.
double pad_hardness(double x, double z);
// Cut through the pad along the row of its hard spot, `half` [m] wide to each side and high: skin, fat, muscle, and the
// spot in white.
Image pad_section(dvec2 half, std::uint32_t size);

}  // namespace pliant::generate
