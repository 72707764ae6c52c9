// The surface that is touched, and the surface that is drawn.
//
// A touch mesh is welded (one vertex per position), its vertices and triangles are in Hilbert order, and it never
// changes after load: heights live in a HeightField. Every run of kZoneSize vertices is a zone, so the zone of vertex v
// is v / kZoneSize. One notion serves sleeping, upload to the card, the flood that finds what a contact reaches, and
// the SIMD batch. Triangles have an implicit tree of their own over runs of kLeafSize (a tree over zones alone would
// leave 256 triangles to test in each leaf). Lifetime: from load to unload. Writer: content. Read by every clock.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "components/math.h"
#include "runtime/store.h"

namespace pliant {

inline constexpr std::uint32_t kZoneSize = 128;        // vertices
inline constexpr std::uint32_t kLeafSize = 4;          // triangles in a leaf of the tree
inline constexpr std::uint32_t kTreeWidth = 4;         // children of an inner box
inline constexpr std::uint32_t kBorder = 0xffffffffu;  // no triangle across this edge

// Boxes over runs of kLeafSize triangles, then over runs of kTreeWidth boxes, up to one root.
// levels[0] are the leaves: leaf i holds triangles [i*kLeafSize, min((i+1)*kLeafSize, count)).
// Box i of level n > 0 holds boxes [i*kTreeWidth, ...) of level n-1. levels.back() has one box.
struct TriangleTree {
  std::vector<std::vector<Box>> levels;
};

struct Mesh {
  std::string name;

  // Touch vertices, rest state, object frame; padded to whole zones (padding: area 0, never indexed).
  std::uint32_t vertex_count = 0;
  std::vector<float> px, py, pz;  // [m] P0
  std::vector<float> nx, ny, nz;  // [1] N0: unit, outward, angle-weighted
  std::vector<float> area;        // [m2] a third of the triangles around the vertex

  std::vector<uvec3> triangles;  // touch vertices, counter-clockwise seen from outside
  std::vector<uvec3> across;  // [triangle][i]: the triangle across the edge from corner i to corner (i+1)%3, or kBorder
  TriangleTree tree;

  std::vector<Box> zone_box;                        // rest box of each zone's vertices and of the triangles around them
  std::vector<std::uint32_t> zone_neighbour_first;  // zones+1: run of each zone in zone_neighbours
  std::vector<std::uint32_t> zone_neighbours;       // zones that share a triangle with it, itself left out

  std::vector<float> stiffness_factor;  // [1] per vertex, painted (_STIFFNESS); empty: 1 everywhere
  std::vector<float> friction_factor;   // [1] per vertex, painted (_FRICTION); empty: 1 everywhere

  Box box;                 // [m] of the rest vertices
  float mean_edge = 0.0f;  // [m]
  bool closed = false;     // every edge has exactly two triangles

  std::uint32_t zone_count() const { return static_cast<std::uint32_t>(zone_box.size()); }
  std::uint32_t zone_begin(std::uint32_t zone) const { return zone * kZoneSize; }
  std::uint32_t zone_end(std::uint32_t zone) const { return std::min((zone + 1) * kZoneSize, vertex_count); }
  vec3 position(std::uint32_t v) const { return {px[v], py[v], pz[v]}; }
  vec3 normal(std::uint32_t v) const { return {nx[v], ny[v], nz[v]}; }
};

// A run of triangles that share a material.
struct DrawPart {
  std::uint32_t first_index = 0;
  std::uint32_t index_count = 0;
  std::int32_t material = -1;  // into World::materials, -1: the default material
};

// A vertex as drawn: touch vertices are split where texture coordinates or shading normals differ. Object frame.
struct DrawVertex {
  vec3 position{0};          // [m]
  vec3 normal{0, 1, 0};      // [1] shading normal (the file's, where it has them)
  vec4 tangent{1, 0, 0, 1};  // [1] w: sign of the bitangent
  vec2 uv{0};
  std::uint32_t touch_vertex = 0;  // whose height and normal correction it takes
};

struct DrawMesh {
  std::vector<DrawVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<DrawPart> parts;
};

}  // namespace pliant
