// Refines a touch mesh that is too coarse to show a dent. New vertices lie on the curved patches
// (components/curved_patch.h), so the surface under a probe is unchanged and rendering agrees with it. Creases are
// kept. Vertex attributes are averaged over the ends of a cut edge.
#pragma once

#include <span>
#include <vector>

#include "content/mesh/mesh_weld.h"

namespace pliant {

inline constexpr double kEdgeOfReach = 1.0 / 3.0;  // [1] of a dent's radius: longest edge that resolves a dent
inline constexpr double kBulgeOfReach = 0.01;      // [1] of it: a patch farther than this from its triangle counts as
                                                   // too coarse
inline constexpr double kSpared = 1.5;             // [1] times those two: below it a mesh is not refined
inline constexpr double kCoarseShare = 0.01;  // [1] of the area: the smallest coarse share for which a mesh is refined
inline constexpr std::size_t kMostAdded = std::size_t{1} << 18;  // triangles per object
inline constexpr std::size_t kMostFiner = std::size_t{1} << 20;  // triangles per object in total

// Whether a relevant share of the surface has edges that are too long, or bulge too much, for dents of radius `reach`
// [m]. A dense mesh with a few long edges does not count.
bool is_coarse(const Mesh& mesh, double reach);

// Refinement at one place to a given edge length (the editor's brush).
struct FinerPlace {
  dmat3 to_object{1};              // lengths are measured in this frame
  dvec3 center{0};                 // [m] in this frame
  double radius = 0;               // [m] about the center; outside, edges may be longer by half the distance
  double edge = 0;                 // [m] longest edge within the radius
  std::vector<std::uint8_t> near;  // per source triangle: edges between corners of such triangles may be cut
};

struct FinerMesh {
  std::vector<Primitive> primitives;  // object frame, wound as touched
  // Per triangle, all primitives in sequence:
  std::vector<std::uint8_t> crease;  // as Mesh::crease
  std::vector<vec3> normal;          // [1] three per triangle: of the corner's smooth part
  bool complete = true;              // false: one more pass would exceed the limit of triangles
};

// Bisects edges until none is coarse, or one more pass would exceed the limit. `primitives` are those from which the
// mesh was built. No primitives in the result: nothing to cut.
FinerMesh make_finer(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
                     const Welded& welded, const Mesh& mesh, double reach);

// The same at one place, for `gathered` in the primitives' own frame and winding. Returns only primitives: in the order
// of the file, without triangles that are neither touched nor drawn.
FinerMesh make_finer_at(const FinerPlace& place, std::span<const Primitive> primitives, const Gathered& gathered,
                        const Welded& welded, const Mesh& mesh);

}  // namespace pliant
