// Solids for the hard cases of geometry.
#pragma once

#include <functional>

#include "scenes/scenes.h"

namespace pliant {

// A solid with flat sides, and the closed form of its point closest to a place outside.
struct Solid {
  const char* name;
  Primitive surface;
  dvec3 corner, out;                    // [m] corner that probes move around; [1] its axis
  std::function<dvec3(dvec3)> closest;  // in closed form
};

inline constexpr double kHalfSolid = 0.04;  // [m] half of a box's side; distance of an octahedron's corners

Solid box_solid();
Solid octahedron_solid();

// A cone about the y axis with its tip at the origin, pointing up.
Primitive cone(int sides, double radius, double height);

}  // namespace pliant
