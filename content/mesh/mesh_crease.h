// Edges over which a surface does not turn smoothly, and the normals of the smooth parts that they leave. Touch takes
// the surface for what the eye takes it for: curved within a smooth part (components/curved_patch.h), split at a
// crease.
#pragma once

#include <span>

#include "content/mesh/mesh_surface.h"
#include "content/mesh/mesh_weld.h"

namespace pliant {

inline constexpr double kNeverCrease = 0.2617993877991494;   // [rad] 15 degrees: a turn that every shading smooths
inline constexpr double kAlwaysCrease = 1.3089969389957472;  // [rad] 75 degrees: a turn that no shading smooths
inline constexpr double kCreaseTurn = 0.7;                   // [rad] in between, where the file has no normals
inline constexpr double kSplitNormals = 0.087;  // [rad] 5 degrees: more than quantisation turns the file's normals by

// Fills Mesh::crease; empty where there is none. `crease_angle` [rad] above 0 alone decides; else the turn, and between
// the two bounds the file's normals: split ones stand for an edge that is meant to be seen.
void find_creases(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
                  const Welded& welded, double crease_angle, Mesh& mesh);

// Fills Mesh::split_normals and corner_normal: around every vertex at a crease, the normal of each fan
// of triangles between creases.
void split_at_creases(const Corners& corners, Mesh& mesh);

// Drops the normals of triangles whose corners all have those of their vertices.
void keep_split_normals(Mesh& mesh);

}  // namespace pliant
