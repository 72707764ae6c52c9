// The draw mesh over a touch mesh. A touch vertex is split only where texture coordinates, shading normals or tangents
// differ. Missing attributes are computed.
#pragma once

#include "content/mesh/mesh_weld.h"

namespace pliant {

// Transforms directions from the file's mesh frame to the object frame.
struct Directions {
  dmat3 tangent;  // the linear part itself
  dmat3 normal;   // its cofactor matrix, which points outward under mirroring too
  float hand;     // -1: mirrors
  explicit Directions(const mat4& to_object) : tangent(dmat4(to_object)) {
    const double determinant = glm::determinant(tangent);
    hand = determinant < 0.0 ? -1.0f : 1.0f;
    normal = dmat3(cross(tangent[1], tangent[2]), cross(tangent[2], tangent[0]), cross(tangent[0], tangent[1])) *
             static_cast<double>(hand);
  }
};

DrawMesh build_draw_mesh(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
                         const Welded& welded, const Mesh& mesh, MeshReport& report);

// Computes tangents from texture coordinates for vertices whose tangent.w is 0: the direction of increasing u. They are
// averaged by corner angle over triangles of one handedness (as MikkTSpace does); a vertex with both is split.
void make_tangents(DrawMesh& draw);

}  // namespace pliant
