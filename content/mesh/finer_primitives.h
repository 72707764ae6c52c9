// Primitives of a refined mesh, in the object frame: a vertex added on an edge takes the mean of the attributes of the
// edge's ends.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "content/mesh/mesh_weld.h"

namespace pliant {

// The same for both directions of an edge.
std::uint64_t edge_key(std::uint32_t a, std::uint32_t b);

class FinerPrimitives {
 public:
  // Without triangles.
  FinerPrimitives(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered);

  // The primitive's vertex in the middle of an edge; added at `position` [m] where the edge is first asked for.
  std::uint32_t middle(std::uint32_t primitive, std::uint32_t a, std::uint32_t b, vec3 position);
  void add_corner(std::uint32_t primitive, std::uint32_t vertex) { primitives_[primitive].index.push_back(vertex); }
  std::vector<Primitive> take() { return std::move(primitives_); }

 private:
  std::vector<Primitive> primitives_;
  std::vector<std::unordered_map<std::uint64_t, std::uint32_t>> middles_;  // of each primitive, by edge
};

}  // namespace pliant
