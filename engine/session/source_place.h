// Where a vertex that refining has made lies among the triangles that a file or a program gave: what is pressed there
// is shared by their corners.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "components/math.h"
#include "content/level/level.h"

namespace pliant {

struct SourcePlace {
  uvec3 vertices{0};       // of a source triangle
  dvec3 weights{1, 0, 0};  // [1] barycentric
};

// Barycentric coordinates of the point of a triangle that is nearest to x.
dvec3 nearest_weights(dvec3 a, dvec3 b, dvec3 c, dvec3 x);

// The nearest point of the source triangles to x. `source`: their vertices, as `triangles` number them, in x's frame.
SourcePlace nearest_source(const std::vector<dvec3>& source, const std::vector<uvec3>& triangles, dvec3 x);

// All triangles of a mesh, its vertices numbered through its primitives.
std::vector<uvec3> source_triangles(const LevelMesh& mesh);

}  // namespace pliant
