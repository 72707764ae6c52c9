// From triangles as read to a touch mesh and a draw mesh: weld, drop what is degenerate or double, normals, tangents,
// Hilbert order, zones, tree. Everything here is deterministic and independent of the number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "components/mesh.h"
#include "content/level.h"
#include "runtime/result.h"

namespace pliant {

// What the mesh lost or lacked on the way.
struct MeshReport {
  std::uint32_t welded_vertices = 0;       // positions that coincided and became one
  std::uint32_t degenerate_triangles = 0;  // zero area or a repeated corner: dropped
  std::uint32_t duplicate_triangles =
      0;                           // the same three corners again, in any order: not touched (a reversed one is drawn)
  std::uint32_t border_edges = 0;  // edges with one triangle
  std::uint32_t non_manifold_edges = 0;  // edges with three or more, or two that disagree on orientation
  std::uint32_t cancelled_normals = 0;   // vertices whose faces cancel: they take the largest face's normal
  bool made_normals = false, made_tangents = false;
};

struct BuiltMesh {
  Mesh mesh;
  DrawMesh draw;
  MeshReport report;
  std::vector<float> pinned, handle;  // [1] per touch vertex, painted (_PINNED, _HANDLE); empty: 0 everywhere
};

// `to_object` takes the primitives' mesh frame to the object frame (scale, shear; a mirroring one flips the winding).
// Fails on: no triangles left, a position that is not finite or beyond 1e9 m, a painted factor below 0, more than 2^28
// vertices.
Result<BuiltMesh> build_mesh(const std::string& name, std::span<const Primitive> primitives, const mat4& to_object);

// The tree over triangles that are already in order (shared with tests and benchmarks).
TriangleTree build_tree(const Mesh& mesh);

}  // namespace pliant
