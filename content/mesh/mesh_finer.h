// A touch mesh too coarse to show a dent, cut finer along the curved surface that it is touched as. New vertices lie on
// the curved patches (components/curved_patch.h), so the surface under a probe stays where it was, and what is drawn
// comes to lie on it. Creases stay creases. What vertices carry is the mean of both ends of the edge that is cut.
#pragma once

#include <span>
#include <vector>

#include "content/mesh/mesh_weld.h"

namespace pliant {

inline constexpr double kEdgeOfReach = 1.0 / 3.0;  // [1] of a dent's radius: with longer edges it is a few triangles
inline constexpr double kBulgeOfReach = 0.01;      // [1] of it: a patch that leaves its triangle farther is seen to
inline constexpr double kSpared = 1.5;             // [1] times those two: below it a mesh is left as the file has it
inline constexpr double kCoarseShare = 0.01;  // [1] of the area: so much must be coarse for a mesh to be cut at all
inline constexpr std::size_t kMostAdded = std::size_t{1} << 18;  // triangles, of one object
inline constexpr std::size_t kMostFiner = std::size_t{1} << 20;  // triangles, of one object in all

// Whether a share of the surface that counts has edges far too long, or that bulge far too much, for dents of radius
// `reach` [m]. A dense mesh with a few long edges is not.
bool is_coarse(const Mesh& mesh, double reach);

// Finer at one place only, to an edge length that somebody asks for (the editor's brush).
struct FinerPlace {
  dmat3 to_object{1};              // lengths are measured after it
  dvec3 center{0};                 // [m] after it
  double radius = 0;               // [m] about the center; farther away, edges may be longer by half the distance
  double edge = 0;                 // [m] no longer within the radius
  std::vector<std::uint8_t> near;  // of each source triangle: edges between corners of such may be cut
};

struct FinerMesh {
  std::vector<Primitive> primitives;  // object frame, wound as touched
  // By triangle, all primitives end to end:
  std::vector<std::uint8_t> crease;  // as Mesh::crease
  std::vector<vec3> normal;          // [1] three of each: of the smooth part that the corner belongs to
  bool complete = true;              // false: one more pass would have made too many triangles
};

// Halves edges until none is coarse, or one more pass would make too many triangles. `primitives` are those that the
// mesh was built from. Without any primitive: there was nothing to cut.
FinerMesh make_finer(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
                     const Welded& welded, const Mesh& mesh, double reach);

// The same at one place, for `gathered` in the primitives' own frame, as they are wound. Only primitives: in the order
// of the file, without triangles that are neither touched nor drawn.
FinerMesh make_finer_at(const FinerPlace& place, std::span<const Primitive> primitives, const Gathered& gathered,
                        const Welded& welded, const Mesh& mesh);

}  // namespace pliant
