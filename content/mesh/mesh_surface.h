// Second half of mesh_build: normals, areas and adjacency of a welded surface.
#pragma once

#include "content/mesh/mesh_build.h"

namespace pliant {

// The triangles around each vertex: corner 3*t + i is corner i of triangle t; ascending per vertex.
struct Corners {
  std::vector<std::uint32_t> first;  // vertices + 1
  std::vector<std::uint32_t> corner;
};
Corners corners_of(const Mesh& mesh);

// The normal of the added corners, weighted as on a sphere (Max 1999).
class NormalSum {
 public:
  void add(const Mesh& mesh, std::uint32_t corner);  // 3*t + i
  vec3 normal() const { return vec3(cancels() ? largest_ : sum_ / length(sum_)); }
  // Cancelling faces (a fold back onto itself) have no direction; the largest face's normal is used instead.
  bool cancels() const { return !(length(sum_) > 1e-6 * weights_); }
  double area() const { return area_; }  // [m2] a third of the triangles' area

 private:
  dvec3 sum_{0}, largest_{0};
  double weights_ = 0.0, area_ = 0.0, largest_area_ = -1.0;
};

// N0 and vertex areas.
void measure_vertices(Mesh& mesh, const Corners& corners, MeshReport& report);
// A side (3*t + i), and the only other side with the same two vertices, in the same direction.
struct SideAgainst {
  std::uint32_t edge, other;
  friend bool operator<(const SideAgainst& a, const SideAgainst& b) { return a.edge < b.edge; }
};

// Fills `across`, `closed` and the counts of border and non-manifold edges. Returns both sides of every edge whose two
// triangles have opposite orientation, ascending.
std::vector<SideAgainst> connect_triangles(Mesh& mesh, const Corners& corners, MeshReport& report);

}  // namespace pliant
