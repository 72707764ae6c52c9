// Recomputes normals and tangents of length zero, which exporters write at degenerate triangles. glTF 2.0 (3.7.2.1)
// requires unit length. Zero, and the residue of cancelling normals, is repaired with a note; any other length is
// rejected.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "components/math.h"
#include "content/gltf/form/gltf_document.h"

namespace pliant {

// The sum of cancelling unit vectors has a rounding error of some 1e-7, below this limit; its direction is meaningless.
inline constexpr double kLeastDirection = 1e-4;  // [1] length
inline bool has_direction(vec3 v) {
  return length(dvec3(v)) >= kLeastDirection;
}

// Gives every normal without a direction the area-weighted normal of its triangles, or else that of a neighbour.
// Returns how many. If any was repaired, the others are normalised. If no vertex has a direction, all normals are
// dropped.
std::size_t mend_normals(std::span<const vec3> position, std::span<const std::uint32_t> index,
                         std::vector<vec3>& normal);

// The same in the bytes of a checked document, so that saving keeps the repair. Tangents become perpendicular to their
// normal.
void mend_directions(SourceDocument& document);

}  // namespace pliant
