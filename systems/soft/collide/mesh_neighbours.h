// What of a collision mesh lies so near to each other along the surface, at rest, that it never collides: a collision
// mesh that collides with itself would otherwise be compared with its own neighbourhood in every step.
#pragma once

#include <cstdint>
#include <vector>

#include "components/mesh.h"

namespace pliant {

class MeshNeighbours {
 public:
  MeshNeighbours() = default;  // nothing is near to anything
  // Vertices are near up to `distance` [m] along edges, and where they share a triangle. `first`, `triangles`: those
  // around vertex v are triangles[first[v]] to triangles[first[v + 1]].
  MeshNeighbours(const Mesh& mesh, double distance, const std::vector<std::uint32_t>& first,
                 const std::vector<std::uint32_t>& triangles);

  bool near(std::uint32_t vertex_a, std::uint32_t vertex_b) const;
  // Of two leaves a <= b of the mesh's tree, bit kLeafSize * i + k: triangles i and k of them have no vertex and no
  // edge that could touch the other's, as near() has it.
  std::uint16_t settled(std::uint32_t leaf_a, std::uint32_t leaf_b) const;

 private:
  void find_near(const Mesh& mesh, double distance, const std::vector<std::uint32_t>& first,
                 const std::vector<std::uint32_t>& triangles);
  void find_settled(const Mesh& mesh, const std::vector<std::uint32_t>& first,
                    const std::vector<std::uint32_t>& triangles);

  struct Leaves {
    std::uint32_t other;
    std::uint16_t settled;
  };
  std::vector<std::uint32_t> near_first_, near_;  // ascending runs per vertex
  std::vector<std::uint32_t> leaves_first_;       // ascending runs per leaf, of leaves not before it
  std::vector<Leaves> leaves_;
};

}  // namespace pliant
