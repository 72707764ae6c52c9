#include "systems/touch/model/relief.h"

#include "systems/touch/model/texture.h"

namespace pliant {
namespace {

// The map's levels pass into each other over an octave: the coarsest that is too fine, and the next.
HeightMap::Sample sample(const std::vector<HeightMap>& levels, dvec2 uv, double finest, bool& faded) {
  std::size_t level = 0;
  for (; level + 1 < levels.size() && levels[level].wavelength <= finest; ++level)
    faded = faded || levels[level].finer;
  const double share = detail_share(levels[level].wavelength, finest);
  faded = faded || (share < 1 && levels[level].finer);
  HeightMap::Sample out = levels[level].at(uv);
  if (share == 1 || level + 1 == levels.size()) return out;
  const HeightMap::Sample coarse = levels[level + 1].at(uv);
  out.height += (1 - share) * (coarse.height - out.height);
  out.slope += (1 - share) * (coarse.slope - out.slope);
  return out;
}

}  // namespace

FeltRelief felt_relief(const Relief& relief, const FootBlend& place, double finest) {
  FeltRelief out;
  for (std::uint32_t f = 0; f < place.count; ++f) {
    const Foot& foot = place.foot[f];
    const std::uint8_t map = relief.map_of[foot.triangle];
    if (map == Relief::kNone) continue;
    const std::array<dvec2, 3>& corner = relief.uv[foot.triangle];
    const std::array<float, 3>& strength = relief.strength[foot.triangle];
    dvec2 uv(0);
    double strong = 0.0;
    for (int i = 0; i < 3; ++i) {
      uv += foot.barycentric[i] * corner[static_cast<std::size_t>(i)];
      strong += foot.barycentric[i] * static_cast<double>(strength[static_cast<std::size_t>(i)]);
    }
    const HeightMap::Sample at = sample(relief.maps[map], uv, finest, out.faded);
    dvec3 gradient(0);
    for (std::size_t i = 0; i < 3; ++i)
      gradient += (strong * dot(at.slope, corner[i]) + at.height * static_cast<double>(strength[i])) * foot.shifts[i];
    out.height += place.weight[f] * strong * at.height;
    out.gradient += place.weight[f] * gradient + strong * at.height * place.weight_slope[f];
  }
  return out;
}

}  // namespace pliant
