// The inside of a soft body: tetrahedra at rest, and how its collision mesh rides on them. Object frame, scale baked
// in. Lifetime: from load to unload. Writer: content. Read by every clock.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "components/math.h"

namespace pliant {

using Tet = std::array<std::uint32_t, 4>;  // nodes; positive volume: (b-a) x (c-a) . (d-a) > 0

// Where a point of the collision mesh stands in the tetrahedra: sum of weight[i] * node[tets[tet][i]]. Weights sum to 1
// and may be negative where the collision mesh stands a little outside.
struct Embedding {
  std::uint32_t tet = 0;
  std::array<double, 4> weight{1, 0, 0, 0};  // [1]
};

// Shape of the worst and of the usual element.
struct TetQuality {
  double smallest_dihedral = 0.0, largest_dihedral = 0.0;  // [rad] over all elements
  double worst_ratio = 0.0, median_ratio = 0.0;            // [1] 3 x inradius / circumradius: 1 regular, 0 flat
};

struct TetMesh {
  std::string name;
  std::vector<dvec3> nodes;        // [m] rest. Order: free ones, then those on the handle, then the pinned
  std::uint32_t free_count = 0;    // nodes [0, free_count) move by themselves
  std::uint32_t handle_count = 0;  // nodes [free_count, free_count + handle_count) belong to the rigid handle
  std::vector<Tet> tets;
  std::vector<Embedding> embedding;  // of each vertex of the body's touch mesh (SoftBody::collision_mesh)
  TetQuality quality;

  std::uint32_t node_count() const { return static_cast<std::uint32_t>(nodes.size()); }
  std::uint32_t pinned_begin() const { return free_count + handle_count; }
};

}  // namespace pliant
