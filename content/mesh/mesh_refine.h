// Cuts triangles until no edge is too long, for a surface that is to follow its carrier.
#pragma once

#include <functional>
#include <vector>

#include "content/level/level.h"

namespace pliant {

inline constexpr std::size_t kMostRefined = std::size_t{1} << 20;  // triangles: the result stays coarser rather than
                                                                   // exceed this

// [m] The longest allowed edge with its midpoint there, object frame.
using LongestEdge = std::function<double(dvec3 middle)>;
// Repeatedly bisects edges longer than that, measured after `to_object`. Vertex attributes are averaged over both ends.
// A shared edge is cut identically everywhere, also across primitives and seams, so that no gap opens. Returns whether
// anything was cut.
bool refine(std::vector<Primitive>& primitives, const mat4& to_object, const LongestEdge& longest);

}  // namespace pliant
