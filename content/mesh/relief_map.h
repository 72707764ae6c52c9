// Heights from the maps of a mesh's materials, so that drawn relief can be felt (components/relief.h).
//
// A height map is taken as it is. A normal map is integrated: the heights h whose differences over u and v are nearest,
// in the least squares, to the slopes that it draws (Frankot & Chellappa 1988, with differences for derivatives; exact
// by a Fourier transform). A map that is tiled repeats. One that is used once does not, and is mirrored for the
// transform: that is the natural boundary.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "components/appearance.h"
#include "components/relief.h"

namespace pliant {

// Whether a material draws relief.
bool draws_relief(const Material& material);

struct ReliefMaps {
  std::shared_ptr<const Relief> relief;  // null: no triangle has a map and coordinates
  double faded = 0.0;                    // [1] share of the area that fades out towards seams of the coordinates
  double uneven = 1.0;                   // [1] largest over mean metres per coordinate: the drawn slopes differ by it
};
ReliefMaps relief_maps(const Mesh& mesh, const DrawMesh& draw, const std::vector<Material>& materials,
                       const std::vector<Image>& images);

// Heights [m], row by row, from slopes between neighbours [m per texel], at texel centres; their mean is 0.
std::vector<float> integrate_slopes(std::uint32_t width, std::uint32_t height, const std::vector<vec2>& slope,
                                    bool repeats);
// The levels of a map whose texels have these heights; `texel` [m] their size.
std::vector<HeightMap> height_levels(std::uint32_t width, std::uint32_t height, std::vector<float> heights,
                                     bool repeats, double texel);

}  // namespace pliant
