// Normals and tangents of length zero, which exporters write at degenerate triangles, made anew.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "components/math.h"
#include "content/gltf/gltf_document.h"

namespace pliant {

// Gives every normal of length zero that of the triangles around it, weighted by area; where they have none, that of a
// neighbour. Says how many. Others are scaled to unit length if any was mended. Where all are zero, they are dropped.
std::size_t mend_normals(std::span<const vec3> position, std::span<const std::uint32_t> index,
                         std::vector<vec3>& normal);

// The same in the bytes of a checked document, so that saving it writes what was mended. Tangents become perpendicular
// to their normal.
void mend_directions(SourceDocument& document);

}  // namespace pliant
