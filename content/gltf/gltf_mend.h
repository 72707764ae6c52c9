// Normals and tangents without a direction, which exporters write at degenerate triangles, made anew. glTF 2.0
// (3.7.2.1) wants unit length; zero, and what is left of normals that cancel, is mended with a note, any other length
// refused.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "components/math.h"
#include "content/gltf/gltf_document.h"

namespace pliant {

// What rounding leaves of unit vectors that cancel is shorter: their sum is off by some 1e-7, and its direction means
// nothing.
inline constexpr double kLeastDirection = 1e-4;  // [1] length
inline bool has_direction(vec3 v) {
  return length(dvec3(v)) >= kLeastDirection;
}

// Gives every normal without a direction that of the triangles around it, weighted by area; where they have none, that
// of a neighbour. Says how many. Others are scaled to unit length if any was mended. Where none has one, they are
// dropped.
std::size_t mend_normals(std::span<const vec3> position, std::span<const std::uint32_t> index,
                         std::vector<vec3>& normal);

// The same in the bytes of a checked document, so that saving it writes what was mended. Tangents become perpendicular
// to their normal.
void mend_directions(SourceDocument& document);

}  // namespace pliant
