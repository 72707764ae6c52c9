// A closed surface mesh of any solid: one vertex per grid cell that the surface crosses, one quadrilateral per grid
// edge that it crosses (Gibson, "Constrained elastic surface nets", 1998). The vertices are then projected onto the
// solid and relaxed along it.
#pragma once

#include <cstdint>
#include <vector>

#include "content/author/solid.h"
#include "content/level/level.h"

namespace pliant::solids {

struct Net {
  std::vector<dvec3> position;   // [m] on the solid
  std::vector<uvec3> triangles;  // counter-clockwise from outside
};

// `box` [m] contains the solid with a margin of one cell. Parts of the solid closer than one cell may merge.
Net cover_by_net(const Solid& solid, const Box& box, double cell);
// Takes normals from the solid. Has no texture coordinates.
Primitive to_primitive(const Net& net, const Solid& solid);

}  // namespace pliant::solids
