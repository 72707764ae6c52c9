// The draw mesh over a touch mesh: a touch vertex is split only where texture coordinates, shading normals or tangents
// differ; what the file lacks is made.
#pragma once

#include "content/mesh_weld.h"

namespace pliant {

DrawMesh build_draw_mesh(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
                         const Welded& welded, const Mesh& mesh, MeshReport& report);

// Per-vertex tangents from texture coordinates for the vertices whose tangent.w is 0: the surface's direction of
// growing u, averaged by corner angle over triangles of one handedness (as MikkTSpace does); a vertex that sees both is
// split.
void make_tangents(DrawMesh& draw);

}  // namespace pliant
