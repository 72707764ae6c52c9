// Triangles cut until no edge is long, for a surface that is to follow what it rides on.
#pragma once

#include <functional>
#include <vector>

#include "content/level/level.h"

namespace pliant {

inline constexpr std::size_t kMostRefined = std::size_t{1} << 20;  // triangles: what would need more stays coarser

// [m] How long an edge may be whose middle lies there, object frame.
using LongestEdge = std::function<double(dvec3 middle)>;
// Halves edges longer than that, measured after `to_object`, again and again; what vertices carry is the mean of both
// ends. An edge is cut alike wherever it is shared, also across primitives and seams, so that nothing opens. Says
// whether anything was cut.
bool refine(std::vector<Primitive>& primitives, const mat4& to_object, const LongestEdge& longest);

}  // namespace pliant
