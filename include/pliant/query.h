// What a program asks about the geometry of a scene (Session::triangles, closest_point, ray, bounds): values of its
// own, in metres, world frame. Triangles and vertices are numbered as the object's MeshData or file has them, its
// primitives end to end.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "pliant/math.h"

namespace pliant {

// Which geometry is asked, and how far.
struct QueryOptions {
  std::string object;  // of Session::objects(); empty: all that are not taken out
  // True: the undeformed shape. A surface's where its object is now, a rigid body's and a tool's too; a soft body's
  // without a handle where the scene put it.
  bool rest = false;
  double within = std::numeric_limits<double>::infinity();  // [m] farther is not looked for; 0 or more
};

// A point of a flat triangle.
struct QueryHit {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t object = kNone;    // into Session::objects(); kNone: nothing is there
  std::uint32_t triangle = kNone;  // into Session::triangles()
  dvec3 barycentric{0};            // [1] of the triangle's three corners
  dvec3 position{0};               // [m] world
  dvec3 normal{0};                 // [1] world, unit, outward, of the flat triangle as it is now
  double distance = 0.0;           // [m] from the point, or along the ray
  bool found() const { return object != kNone; }
};

// An axis-aligned box, world frame.
struct Bounds {
  dvec3 min{0}, max{0};  // [m]
};

}  // namespace pliant
