// Finds creases, and the normals of the smooth parts between them. Touch treats the surface as it looks: curved within
// a smooth part (components/curved_patch.h), split at a crease.
#pragma once

#include <span>

#include "content/mesh/mesh_surface.h"
#include "content/mesh/mesh_weld.h"

namespace pliant {

inline constexpr double kNeverCrease = 0.2617993877991494;   // [rad] 15 degrees: smaller angles are always smooth
inline constexpr double kAlwaysCrease = 1.3089969389957472;  // [rad] 75 degrees: larger angles are always creases
inline constexpr double kCreaseTurn = 0.7;                   // [rad] threshold in between, if the file has no normals
inline constexpr double kSplitNormals = 0.087;  // [rad] 5 degrees: more than the quantisation error of the file's
                                                // normals

// Fills Mesh::crease; empty if there is none. A `crease_angle` [rad] above 0 is the only criterion. Otherwise the angle
// decides; between the two bounds, split normals in the file make an edge a crease.
void find_creases(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
                  const Welded& welded, double crease_angle, Mesh& mesh);

// Fills Mesh::split_normals and corner_normal: around every vertex at a crease, the normal of each fan of triangles
// between creases; around the point of a cone, each triangle's own.
void split_at_creases(const Corners& corners, Mesh& mesh);

// Removes entries of triangles whose corner normals all equal their vertex normals.
void keep_split_normals(Mesh& mesh);

}  // namespace pliant
