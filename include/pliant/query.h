// Geometry queries of a scene (Session::triangles, closest_point, ray, bounds): copies, in metres, world frame.
// Triangles and vertices are numbered as in the object's MeshData or file, its primitives in sequence.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "pliant/math.h"

namespace pliant {

// The geometry to query, and the range.
struct QueryOptions {
  std::string object;  // of Session::objects(); empty: all that are not taken out
  // True: the undeformed shape, at the object's current pose. A soft body without a handle is at its pose in the scene.
  bool rest = false;
  double within = std::numeric_limits<double>::infinity();  // [m] search radius; 0 or more
};

// A point of a flat triangle.
struct QueryHit {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t object = kNone;    // into Session::objects(); kNone: nothing found
  std::uint32_t triangle = kNone;  // into Session::triangles()
  dvec3 barycentric{0};            // [1] of the triangle's three corners
  dvec3 position{0};               // [m] world
  dvec3 normal{0};                 // [1] world, unit, outward, of the flat triangle in its current state
  double distance = 0.0;           // [m] from the point, or along the ray
  bool found() const { return object != kNone; }
};

// An axis-aligned box, world frame.
struct Bounds {
  dvec3 min{0}, max{0};  // [m]
};

}  // namespace pliant
