// Vertices of a refined touch mesh: those of the mesh, and added ones on its curved patches
// (components/curved_patch.h).
#pragma once

#include <cstdint>
#include <vector>

#include "components/curved_patch.h"
#include "components/mesh.h"

namespace pliant {

class PatchVertices {
 public:
  explicit PatchVertices(const Mesh& mesh);

  // Adds the point at the barycentrics `at` [1] of a triangle's corners 1 and 2. Its normal is the patch's; on an edge
  // shared by two smooth patches, the mean of both. `edge`: the triangle's edge that contains it, or -1.
  std::uint32_t add(std::uint32_t triangle, vec2 at, int edge);
  vec3 position(std::uint32_t vertex) const { return position_[vertex]; }  // [m]
  // [1] Of a vertex that lies at `at` of the triangle with this patch.
  vec3 normal_at(std::uint32_t triangle, std::uint32_t vertex, vec2 at, const CurvedPatch& patch) const;

 private:
  vec2 seen_from(std::uint32_t other, std::uint32_t triangle, int edge, vec2 at) const;
  dvec3 patch_normal(std::uint32_t triangle, const CurvedPatch& patch, vec2 at) const;

  const Mesh& mesh_;
  std::vector<vec3> position_;     // [m] of every vertex
  std::vector<vec3> normal_;       // [1] of added vertices
  std::vector<std::uint8_t> own_;  // per added vertex: on a crease, with one normal per side
};

}  // namespace pliant
