// The interpolated contact vertex (P1 section 4; methods.md 1.5): the point of a triangle whose interpolated normal
// passes through x,   P(u,v) + t N(u,v) = x,   with P and N linear over the triangle and N not normalised.
//
// The three vectors [(P1-P0) + t (N1-N0), (P2-P0) + t (N2-N0), (P0-x) + t N0] are then linearly dependent: a cubic in
// t. Solved in double; object frame throughout.
#pragma once

#include <cstdint>

#include "components/math.h"
#include "components/mesh.h"

namespace pliant {

// Foot of x on the surface. (The contact point of a body is in systems/soft/body/body.h.)
struct SurfaceFoot {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t triangle = kNone;
  dvec3 barycentric{1, 0, 0};  // [1] of the three corners
  dvec3 foot{0};               // [m] P(u,v)
  dvec3 normal{0, 1, 0};       // [1] N(u,v), unit
  double height = 0.0;         // [m] signed distance of x from the foot: > 0 outside
  bool interpolated = false;   // x lies on the interpolated normal; false: closest point

  bool valid() const { return triangle != kNone; }
  double distance() const { return height < 0 ? -height : height; }
};

// A triangle's corners and normals in double.
struct Corner3 {
  dvec3 p[3], n[3];
};
Corner3 corners(const Mesh& mesh, std::uint32_t triangle);

// Foot, unit normal and height at given barycentrics.
SurfaceFoot surface_point(const Corner3& c, std::uint32_t triangle, dvec3 barycentric, double height);

// The virtual vertex with the smallest |height| on this triangle. Invalid if x projects beside the triangle or is
// beyond the focal distance.
SurfaceFoot virtual_vertex(const Mesh& mesh, std::uint32_t triangle, dvec3 x);

// Barycentrics of the virtual vertex whose height continues `height`. They may be outside the triangle; their signs
// identify the edge to cross. False at the focal distance, where normals meet, or if the iteration does not converge.
bool continue_virtual_vertex(const Corner3& c, dvec3 x, dvec3& barycentric, double& height);

// Barycentrics of the closest point of a flat triangle.
dvec3 closest_barycentric(const dvec3 (&corner)[3], dvec3 x);

// False only if no interpolated normal of the triangle can reach x. This is so if x is farther beside the triangle's
// plane than the most inclined corner normal leans; its closest point is sqrt(distance2) away [m]. Saves solving the
// cubic.
bool may_have_virtual_vertex(const Mesh& mesh, std::uint32_t triangle, dvec3 x, double distance2);

// The closest point of the triangle, with the interpolated normal there; the sign of its height is the side of that
// normal.
SurfaceFoot closest_point(const Mesh& mesh, std::uint32_t triangle, dvec3 x);

}  // namespace pliant
