// Builds a touch mesh and a draw mesh from triangles: welding, removal of degenerate and duplicate triangles, normals,
// tangents, Hilbert order, zones, tree. All steps are deterministic, whatever the number of threads.
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

// Repairs and defects of the mesh.
struct MeshReport {
  std::uint32_t welded_vertices = 0;  // coincident positions that were merged
  std::uint32_t joined_vertices = 0;  // of borders, merged with another that was nearer than rounding (mesh_border.h)
  std::uint32_t degenerate_triangles = 0;  // zero area or a repeated corner: dropped
  std::uint32_t duplicate_triangles =
      0;                           // the same three corners again, in any order: not touched (a reversed one is drawn)
  std::uint32_t flush_walls = 0;   // pairs of triangles at which parts are flush: dropped (flush_walls.h)
  std::uint32_t border_edges = 0;  // edges with one triangle
  std::uint32_t non_manifold_edges = 0;  // edges with three or more, or two that disagree on orientation
  std::uint32_t turned_triangles = 0;    // turned to agree with the larger area of their part
  std::uint32_t turned_parts = 0;        // inside out as a whole: turned
  std::uint32_t unorientable_parts = 0;  // one-sided (a Moebius strip): left as they are
  std::uint32_t undecided_parts = 0;     // may be inside out, but undecidable: left as they are
  std::uint32_t refined_from = 0;        // triangles before refinement; 0: not refined
  std::uint32_t cancelled_normals = 0;   // vertices whose face normals cancel: they take the largest face's normal
  bool made_normals = false, made_tangents = false;
};

// On turned triangles, if there are any.
std::optional<Note> winding_note(const MeshReport& report);
// On triangles whose winding may be wrong but could not be decided.
std::optional<Note> winding_doubt(const MeshReport& report);

struct BuiltMesh {
  Mesh mesh;
  DrawMesh draw;
  MeshReport report;
  std::vector<float> pinned, handle;  // [1] per touch vertex, painted (_PINNED, _HANDLE); empty: 0 everywhere
};

struct MeshOptions {
  double crease_angle = 0.0;      // [rad] edges with a larger angle are creases; 0: mesh_crease.h decides
  std::optional<DentSize> dents;  // the mesh is refined until these are resolved (mesh_finer.h); empty: no refinement
  bool mend_winding = true;       // false: only drawn, with the file's winding (a room is seen from inside)
};

// `to_object`: the primitives' mesh frame to the object frame (scale, shear; a mirroring one flips the winding).
// Errors: no triangles left, a position not finite or beyond 1e9 m, a painted factor below 0, more than 2^28 vertices.
Result<BuiltMesh> build_mesh(const std::string& name, std::span<const Primitive> primitives, const mat4& to_object,
                             const MeshOptions& options = {});

// The tree over triangles that are already ordered (shared with tests and benchmarks).
TriangleTree build_tree(const Mesh& mesh);

}  // namespace pliant
