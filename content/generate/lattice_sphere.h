// A closed surface over the octahedron's lattice: every vertex is an integer point with |x| + |y| + |z| = n. The
// lattice unfolds into a square without distortion (Praun & Hoppe, "Spherical parametrization and remeshing", 2003),
// which gives texture coordinates whose only seams are four lines on the far side (-Z).
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
    vec2 uv;  // the border of the square, with a margin, so that texture filters stay inside
  };
  std::vector<std::array<Corner, 3>> triangles;  // counter-clockwise from outside
};

// Covers `solid` (one that a sphere can be shrunk onto) with 8 n^2 near-equilateral, evenly sized triangles, n = coarse
// * 2^doublings: each level is relaxed along the surface before it is split, so that size evens out over long
// distances.
LatticeSphere cover(const Solid& solid, int coarse, int doublings);

// A place in the unfolded square (texture coordinates) as a triangle of lattice points and barycentric weights.
struct LatticePlace {
  std::array<LatticePoint, 3> corner;
  dvec3 weight{0};
};
LatticePlace place_at(int n, dvec2 uv);

// As a primitive with normals from the solid and texture coordinates; vertices on the seams are there once for each
// side.
Primitive to_primitive(const LatticeSphere& sphere, const Solid& solid);

}  // namespace pliant::generate
