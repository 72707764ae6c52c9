// Second half of mesh_build: what a welded surface says about itself — normals, areas, who is across which edge.
#pragma once

#include "content/mesh_build.h"

namespace pliant {

// Which triangles stand around a vertex: corner 3*t + i is corner i of triangle t; ascending within a vertex.
struct Corners {
  std::vector<std::uint32_t> first;  // vertices + 1
  std::vector<std::uint32_t> corner;
};
Corners corners_of(const Mesh& mesh);

// N0 (angle-weighted: Thuermer & Wuethrich, "Computing vertex normals from polygonal facets", 1998) and vertex areas.
void measure_vertices(Mesh& mesh, const Corners& corners, MeshReport& report);
// `across`, `closed` and the counts of borders and non-manifold edges.
void connect_triangles(Mesh& mesh, const Corners& corners, MeshReport& report);

}  // namespace pliant
