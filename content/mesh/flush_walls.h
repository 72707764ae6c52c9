// Walls of zero thickness inside a body: triangles at which parts of one mesh are flush, once from each part. They are
// neither touched nor drawn, so that the parts' surfaces join.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "components/math.h"

namespace pliant {

// Which of the triangles are such walls. `two_sided`: the triangle is there reversed, too. A connected part of those is
// a wall if tissue surrounds it: at each edge of its rim two other triangles meet, and it lies behind them. A two-sided
// sheet has a free rim; a septum between two cavities lies in front of the triangles at its rim.
std::vector<std::uint8_t> flush_walls(std::span<const vec3> position, std::span<const uvec3> triangle,
                                      const std::vector<std::uint8_t>& two_sided);

}  // namespace pliant
