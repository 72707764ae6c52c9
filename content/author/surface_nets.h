// A closed surface over any solid, whatever its shape: one vertex in every cell of a grid that the surface crosses,
// one quadrilateral across every edge that it cuts (Gibson, "Constrained elastic surface nets", 1998), then pulled
// onto the solid and relaxed along it.
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

// `box` [m] holds the whole solid with a cell to spare; parts of the solid closer to each other than a cell may join.
Net cover_by_net(const Solid& solid, const Box& box, double cell);
// With normals from the solid; no texture coordinates.
Primitive to_primitive(const Net& net, const Solid& solid);

}  // namespace pliant::solids
