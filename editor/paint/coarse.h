// Whether a mesh is fine enough for a brush, and what to do where it is not.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "editor/paint/brush.h"

namespace pliant {

struct CoarseMesh {
  double edge = 0.0;    // [m] the longest near the middle of the brush
  double wanted = 0.0;  // [m] what refine_under should be asked for
  std::string sentence;
};
// Nothing: the mesh under the brush is fine enough. By the measure that the engine cuts coarse meshes with
// (kEdgeOfReach, kSpared of mesh_finer.h), the brush's radius in the place of a dent's.
std::optional<CoarseMesh> coarse_for(const Brush& brush, const PaintSurface& surface, const SurfaceHit& hit,
                                     MarchWork& work);

struct RefinedMesh {
  LevelMesh mesh;  // the vertices that it had keep their places in the arrays and all their values
  std::size_t triangles_before = 0, triangles_after = 0;
  std::string sentence;  // what was done, with numbers
};
// Edges within `radius` [m] of the hit become no longer than `edge` [m], and farther away gradually as long as they
// were. New vertices lie on the curved surface that the mesh is touched as; texture coordinates, normals, tangents and
// painted values are the means of the ends of the edge that is cut. What lies behind a thin wall stays as it is.
// `surface` is of this mesh. The surface, its hits and the layers of its paint are to be made anew; store() them first.
Result<RefinedMesh> refine_under(const LevelMesh& mesh, const PaintSurface& surface, const SurfaceHit& hit,
                                 double radius, double edge);

}  // namespace pliant
