// Iterates the triangles around a vertex, over their shared edges.
#pragma once

#include <cstdint>

#include "components/mesh.h"

namespace pliant {

inline int corner_of(const uvec3& t, std::uint32_t v) {
  return t.x == v ? 0 : t.y == v ? 1 : 2;
}

// Calls visit(triangle) for the triangles around a vertex, starting at `first` and going round over the left edges.
// Where that ends (a border, or an edge that `crosses(triangle, edge)` forbids), continues from `first` over the right
// edges.
template <class Crosses, class Visit>
void around_vertex(const Mesh& mesh, std::uint32_t vertex, std::uint32_t first, Crosses crosses, Visit visit) {
  constexpr int kMost = 256;
  std::uint32_t t = first;
  for (int n = 0; n < kMost; ++n) {
    visit(t);
    const int edge = (corner_of(mesh.triangles[t], vertex) + 2) % 3;
    const std::uint32_t next = mesh.across[t][edge];
    if (next == first) return;
    if (next == kBorder || !crosses(t, edge)) break;
    t = next;
  }
  t = first;
  for (int n = 0; n < kMost; ++n) {
    const int edge = corner_of(mesh.triangles[t], vertex);
    const std::uint32_t next = mesh.across[t][edge];
    if (next == kBorder || next == first || !crosses(t, edge)) return;
    t = next;
    visit(t);
  }
}

template <class Visit>
void around_vertex(const Mesh& mesh, std::uint32_t vertex, std::uint32_t first, Visit visit) {
  around_vertex(
      mesh, vertex, first, [](std::uint32_t, int) { return true; }, visit);
}

}  // namespace pliant
