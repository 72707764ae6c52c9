// The surface that is touched, and the surface that is drawn.
//
// A touch mesh is welded (one vertex per position). Its vertices and triangles are in Hilbert order, and it never
// changes after load: heights are in a HeightField. Every run of kZoneSize vertices is a zone, so the zone of vertex v
// is v / kZoneSize. Zones serve sleeping, upload to the GPU, the flood fill of a contact's reach, and the SIMD batch.
// Triangles have separate trees (a tree over zones alone would leave 256 triangles to test in each leaf). Lifetime:
// from load to unload. Writer: content. Read by every clock.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "components/math.h"
#include "runtime/store.h"

namespace pliant {

inline constexpr std::uint32_t kZoneSize = 128;          // vertices
inline constexpr std::uint32_t kLeafSize = 4;            // triangles in a leaf of the tree
inline constexpr std::uint32_t kTreeWidth = 4;           // children of an inner box
inline constexpr std::uint32_t kBorder = 0xffffffffu;    // no triangle across this edge
inline constexpr std::uint32_t kNotSplit = 0xffffffffu;  // split_normals of a triangle that uses its vertices' normals

// Eight boxes in structure-of-arrays layout, so that one query tests all eight at once; four cache lines. A place is a
// node (count 0) or a run of at most kTreeNodeWidth triangles; places from `used` on are empty boxes.
inline constexpr std::uint32_t kTreeNodeWidth = 8;
struct alignas(64) TreeNode {
  float low[3][kTreeNodeWidth];         // [m] object frame
  float high[3][kTreeNodeWidth];        // [m]
  std::uint32_t first[kTreeNodeWidth];  // node, or first triangle
  std::uint8_t count[kTreeNodeWidth];   // triangles; 0: a node
  std::uint32_t used = 0;
};

// Two trees over the triangles in their order.
//
// `levels`: boxes over runs of kLeafSize triangles, then over runs of kTreeWidth boxes, up to one root. They serve
// moving meshes (systems/soft/collide/collision_mesh.h refits such boxes) and sums over runs. levels[0] are the leaves:
// leaf i holds triangles [i*kLeafSize, min((i+1)*kLeafSize, count)). Box i of level n > 0 holds boxes [i*kTreeWidth,
// ...) of level n-1. levels.back() has one box.
//
// `nodes`: for queries at rest (systems/touch/collide/triangle_tree.h). Its runs are cut where the boxes get small, and
// its boxes also hold the control points of the triangles' curved patches. nodes[0] is the root; children follow their
// parents.
struct TriangleTree {
  std::vector<std::vector<Box>> levels;
  std::vector<TreeNode> nodes;
  float bulge = 0.0f;  // [m] largest distance of a curved patch's control point from its triangle
};

struct Relief;  // components/relief.h

struct Mesh {
  std::string name;

  // Touch vertices, rest state, object frame; padded to whole zones (padding: area 0, never indexed).
  std::uint32_t vertex_count = 0;
  std::vector<float> px, py, pz;  // [m] P0
  std::vector<float> nx, ny, nz;  // [1] N0: unit, outward; exact on a sphere, except for needle triangles
  std::vector<float> area;        // [m2] a third of the triangles around the vertex

  std::vector<uvec3> triangles;  // touch vertices, counter-clockwise seen from outside
  std::vector<uvec3> across;  // [triangle][i]: the triangle across the edge from corner i to corner (i+1)%3, or kBorder
  TriangleTree tree;

  std::vector<Box> zone_box;                        // rest box of each zone's vertices and of the triangles around them
  std::vector<std::uint32_t> zone_neighbour_first;  // zones+1: run of each zone in zone_neighbours
  std::vector<std::uint32_t> zone_neighbours;       // zones that share a triangle with it, itself excluded

  // Creases: edges with a discontinuous normal. Both are empty on a mesh without creases.
  std::vector<std::uint8_t> crease;          // per triangle: bit i is set if edge i (corner i to (i+1)%3) is a crease
  std::vector<std::uint32_t> split_normals;  // per triangle: index of its corner 0 in corner_normal, or kNotSplit
  std::vector<vec3> corner_normal;           // [1] three in a row for every triangle with split normals: unit, outward,
                                             // of the smooth part of the surface that the corner belongs to

  // Painted per vertex; empty: 1 everywhere.
  std::vector<float> stiffness_factor;   // [1] _STIFFNESS
  std::vector<float> friction_factor;    // [1] _FRICTION
  std::vector<float> damping_factor;     // [1] _DAMPING: of damping_ratio and contact_damping
  std::vector<float> relaxation_factor;  // [1] _RELAXATION: of relaxation.stiffness (standard linear solid)

  std::shared_ptr<const Relief> relief;  // of its materials, to be felt; null: none, or nobody asked for it

  // Touch vertex of each source vertex, primitives end to end; kBorder: no touched triangle uses it.
  std::vector<std::uint32_t> of_source;

  Box box;                 // [m] of the rest vertices
  float mean_edge = 0.0f;  // [m]
  float file_edge = 0.0f;  // [m] the same before refinement: what the author resolved
  bool closed = false;     // every edge has exactly two triangles

  std::uint32_t zone_count() const { return static_cast<std::uint32_t>(zone_box.size()); }
  std::uint32_t zone_begin(std::uint32_t zone) const { return zone * kZoneSize; }
  std::uint32_t zone_end(std::uint32_t zone) const { return std::min((zone + 1) * kZoneSize, vertex_count); }
  vec3 position(std::uint32_t v) const { return {px[v], py[v], pz[v]}; }
  vec3 normal(std::uint32_t v) const { return {nx[v], ny[v], nz[v]}; }
  bool is_crease(std::uint32_t triangle, int edge) const { return !crease.empty() && (crease[triangle] >> edge & 1); }
  // Normal of the smooth surface on the triangle's side of any crease. [1]
  vec3 normal(std::uint32_t triangle, int corner) const {
    if (split_normals.empty() || split_normals[triangle] == kNotSplit) return normal(triangles[triangle][corner]);
    return corner_normal[split_normals[triangle] + static_cast<std::uint32_t>(corner)];
  }
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
  std::uint32_t touch_vertex = 0;  // supplies its height and normal correction
};

struct DrawMesh {
  std::vector<DrawVertex> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<DrawPart> parts;
};

}  // namespace pliant
