// The place of a refined vertex among the source triangles: a force on it is distributed over their corners.
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

// Barycentric coordinates of the triangle's point nearest to x.
dvec3 nearest_weights(dvec3 a, dvec3 b, dvec3 c, dvec3 x);

// The point of the source triangles nearest to x. `source`: their vertices in x's frame, numbered as in `triangles`.
SourcePlace nearest_source(const std::vector<dvec3>& source, const std::vector<uvec3>& triangles, dvec3 x);

// All triangles of a mesh, with vertices numbered through its primitives.
std::vector<uvec3> source_triangles(const LevelMesh& mesh);

}  // namespace pliant
