// Pairs of features of a collision mesh so close to each other along the surface, at rest, that they never collide.
// Otherwise a self-colliding mesh would be compared with its neighbourhood in every step.
#pragma once

#include <cstdint>
#include <vector>

#include "components/mesh.h"

namespace pliant {

class MeshNeighbours {
 public:
  MeshNeighbours() = default;  // no neighbours
  // Vertices are near up to `distance` [m] along edges, and if they share a triangle. `first`, `triangles`: those
  // around vertex v are triangles[first[v]] to triangles[first[v + 1]].
  MeshNeighbours(const Mesh& mesh, double distance, const std::vector<std::uint32_t>& first,
                 const std::vector<std::uint32_t>& triangles);

  bool near(std::uint32_t vertex_a, std::uint32_t vertex_b) const;
  // For two leaves a <= b of the mesh's tree, bit kLeafSize * i + k: no vertex or edge of their triangles i and k can
  // touch the other's, by near().
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
