// Tests whether a mesh is fine enough for a brush, and refines it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "editor/paint/brush.h"

namespace pliant {

struct CoarseMesh {
  double edge = 0.0;    // [m] the longest near the middle of the brush
  double wanted = 0.0;  // [m] edge length to request from refine_under
  std::string sentence;
};
// Empty: the mesh under the brush is fine enough. Uses the engine's criterion for coarse meshes (kEdgeOfReach, kSpared
// of mesh_finer.h), with the brush's radius instead of a dent's.
std::optional<CoarseMesh> coarse_for(const Brush& brush, const PaintSurface& surface, const SurfaceHit& hit,
                                     MarchWork& work);

struct RefinedMesh {
  LevelMesh mesh;  // existing vertices keep their indices and all their values
  std::size_t triangles_before = 0, triangles_after = 0;
  std::string sentence;  // what was done, with numbers
};
// Edges within `radius` [m] of the hit become at most `edge` [m] long; farther away the limit increases gradually. New
// vertices lie on the curved touch surface; texture coordinates, normals, tangents and painted values are averaged over
// the ends of the cut edge. The far side of a thin wall is unchanged. `surface` is of this mesh. Surface, hits and
// paint layers must be rebuilt afterwards; store() them first.
Result<RefinedMesh> refine_under(const LevelMesh& mesh, const PaintSurface& surface, const SurfaceHit& hit,
                                 double radius, double edge);

}  // namespace pliant
