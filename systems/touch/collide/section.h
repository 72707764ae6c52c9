// Walks along the section of a surface by a plane, from triangle to triangle.
#pragma once

#include <cstdint>

#include "components/mesh.h"

namespace pliant {

// A triangle's edge from corner `edge` to the next, and the share of it at which the plane crosses it.
struct SectionEdge {
  std::uint32_t triangle;
  int edge;
  double share;
  dvec3 p;  // [m] there
};

// The section by the plane through `on` with normal `across`, from a triangle that it crosses, in the direction across
// x outward normal. Calls visit(SectionEdge) at each edge; ends where it returns false. Returns whether the section
// reached the triangle `to`.
template <class Visit>
bool walk_section(const Mesh& mesh, std::uint32_t from, std::uint32_t to, dvec3 on, dvec3 across, Visit visit) {
  constexpr int kMost = 512;  // triangles
  for (int step = 0; step < kMost && from != to; ++step) {
    const uvec3 t = mesh.triangles[from];
    double side[3];
    for (int i = 0; i < 3; ++i) side[i] = dot(dvec3(mesh.position(t[i])) - on, across);
    int edge = 0;
    while (edge < 3 && !(side[edge] < 0 && side[(edge + 1) % 3] >= 0)) ++edge;
    if (edge == 3) return false;
    const double share = side[edge] / (side[edge] - side[(edge + 1) % 3]);
    const dvec3 a(mesh.position(t[edge])), b(mesh.position(t[(edge + 1) % 3]));
    if (!visit(SectionEdge{from, edge, share, a + share * (b - a)})) return false;
    from = mesh.across[from][edge];
    if (from == kBorder) return false;
  }
  return from == to;
}

// A point of a triangle, moved a little off its edges and corners: a plane through it crosses the triangle.
inline dvec3 inside_triangle(const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric) {
  const uvec3 t = mesh.triangles[triangle];
  const dvec3 b = barycentric + 1e-3 * (dvec3(1.0 / 3) - barycentric);
  return b.x * dvec3(mesh.position(t.x)) + b.y * dvec3(mesh.position(t.y)) + b.z * dvec3(mesh.position(t.z));
}

}  // namespace pliant
