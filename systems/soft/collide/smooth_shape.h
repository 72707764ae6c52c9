// The smooth surface that a collision mesh approximates, in its rest shape and object frame.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "components/mesh.h"

namespace pliant {

struct CollisionEdge;

struct SmoothShape {
  std::vector<dvec3> normal;  // [1] per vertex, by Max's weights (1999): exact on a sphere; zero if sharp
  // [1/m] Per vertex: shape operator, the normal changes by bend dx; along the normal, where it is not defined, the
  // mean curvature, so that tangents that are slightly off see the same. Zero if sharp.
  std::vector<dmat3> bend;
  std::vector<std::uint8_t> smooth;  // per vertex
  double bulge = 0.0;                // [m] over the middle of a triangle, at most

  SmoothShape() = default;
  SmoothShape(const Mesh& mesh, std::span<const CollisionEdge> edges, const std::vector<std::uint8_t>& smooth);
  // [m] Height over a point of a triangle, along its normal: quadratic in the barycentrics.
  double rise(const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric) const;
};

// [1/m] Per vertex, symmetric: least squares over its edges, equally weighted.
std::vector<dmat3> shape_operators(const Mesh& mesh, std::span<const CollisionEdge> edges,
                                   const std::vector<dvec3>& normal);
void average_over_neighbours(std::span<const CollisionEdge> edges, const std::vector<std::uint8_t>& smooth,
                             std::vector<dmat3>& bend);

}  // namespace pliant
