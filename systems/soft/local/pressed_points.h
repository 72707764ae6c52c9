// Points that stand for a surface in contacts with split tissue (methods.md 2.10): each has a part of the surface's
// area, and both are fixed to the body. A patch that is pressed steadily keeps its contacts and their areas; one that
// grows takes up points one by one, each without force at first.
#pragma once

#include <cstdint>
#include <vector>

#include "components/mesh.h"

namespace pliant {

struct PressedPoint {
  std::uint32_t triangle = 0;
  dvec3 barycentric{1, 0, 0};  // [1]
  dvec3 at{0};                 // [m] object frame, at rest
  double area = 0.0;           // [m2]
};

// The whole surface by points of equal areas, as far as its triangles allow.
struct PointLevel {
  double spacing = 0.0;  // [m] root of the mean area
  std::vector<PressedPoint> points;
};

// From fine to coarse: about 6,000 points, then half as many from level to level, down to 40 and no fewer than one for
// each side of a box. The areas of each level add up to the surface's. Points share an area only with points that face
// alike.
std::vector<PointLevel> pressed_points(const Mesh& mesh);

}  // namespace pliant
