// A closed surface over the octahedron's lattice: every vertex is an integer point with |x| + |y| + |z| = n. The
// lattice unfolds into a square without distortion (Praun & Hoppe, "Spherical parametrization and remeshing", 2003).
// The resulting texture coordinates have only four seams, all on the far side (-Z).
#pragma once

#include <array>
#include <map>
#include <vector>

#include "content/generate/solid.h"
#include "content/level/level.h"

namespace pliant::generate {

using LatticePoint = std::array<int, 3>;

struct LatticeSphere {
  int n = 0;  // subdivisions of an octahedron's edge
  std::map<LatticePoint, std::uint32_t> vertex;
  std::vector<dvec3> position;  // [m]
  struct Corner {
    std::uint32_t vertex;
    vec2 uv;  // within the square less a margin, so that texture filters stay inside
  };
  std::vector<std::array<Corner, 3>> triangles;  // counter-clockwise from outside
};

// Covers `solid` (star-shaped, so that a sphere can be shrunk onto it) with 8 n^2 near-equilateral, evenly sized
// triangles, n = coarse * 2^doublings. Each level is relaxed along the surface before it is split, which evens out
// sizes over long distances.
LatticeSphere cover(const Solid& solid, int coarse, int doublings);

// A point of the unfolded square (texture coordinates) as a lattice triangle and barycentric weights.
struct LatticePlace {
  std::array<LatticePoint, 3> corner;
  dvec3 weight{0};
};
LatticePlace place_at(int n, dvec2 uv);

// A primitive with normals from the solid and texture coordinates. Vertices on seams are duplicated, one for each side.
Primitive to_primitive(const LatticeSphere& sphere, const Solid& solid);

}  // namespace pliant::generate
