// From triangles as read to a touch mesh and a draw mesh: weld, drop what is degenerate or double, normals, tangents,
// Hilbert order, zones, tree. Everything here is deterministic and independent of the number of threads.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "components/deformable.h"
#include "components/mesh.h"
#include "content/level/level.h"
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
  std::uint32_t turned_triangles = 0;    // wound against the larger area of their part: turned
  std::uint32_t turned_parts = 0;        // wound inside out as a whole: turned
  std::uint32_t unorientable_parts = 0;  // have one side only (a Moebius strip): left as they are
  std::uint32_t undecided_parts = 0;     // may be inside out, but nothing tells: left as they are
  std::uint32_t refined_from = 0;        // triangles before the mesh was cut finer; 0: it was not
  std::uint32_t cancelled_normals = 0;   // vertices whose faces cancel: they take the largest face's normal
  bool made_normals = false, made_tangents = false;
};

// One sentence on what was turned over; empty: nothing was.
std::string winding_note(const MeshReport& report);
// ... and one on what may be wound wrongly but could not be decided.
std::string winding_doubt(const MeshReport& report);

struct BuiltMesh {
  Mesh mesh;
  DrawMesh draw;
  MeshReport report;
  std::vector<float> pinned, handle;  // [1] per touch vertex, painted (_PINNED, _HANDLE); empty: 0 everywhere
};

struct MeshOptions {
  double crease_angle = 0.0;      // [rad] edges that turn by more are creases; 0: mesh_crease.h decides
  std::optional<DentSize> dents;  // cut finer until they show (mesh_finer.h); nothing: as the file has it
  bool mend_winding = true;       // false: only drawn, as the file has it (a room is seen from within)
};

// `to_object` takes the primitives' mesh frame to the object frame (scale, shear; a mirroring one flips the winding).
// Fails on: no triangles left, a position that is not finite or beyond 1e9 m, a painted factor below 0, more than 2^28
// vertices.
Result<BuiltMesh> build_mesh(const std::string& name, std::span<const Primitive> primitives, const mat4& to_object,
                             const MeshOptions& options = {});

// The tree over triangles that are already in order (shared with tests and benchmarks).
TriangleTree build_tree(const Mesh& mesh);

}  // namespace pliant
