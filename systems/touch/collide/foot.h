// The foot of a point on a surface: a local minimum of the distance to it, tracked as the point moves. It is P1's
// interpolated contact vertex where both exist, a proxy elsewhere (methods.md 1.5). The surface consists of the curved
// patches of components/curved_patch.h. A force along x - p that depends on |x - p| alone is then conservative on any
// mesh: the distance's gradient is that direction.
//
// A foot is inside a patch, on an edge (a crease, or where two patches meet at a slight angle) or on a vertex. Object
// frame, double.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "components/math.h"
#include "components/mesh.h"

namespace pliant {

enum class FootPlace : std::uint8_t { kInside, kEdge, kVertex };

struct Foot {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t triangle = kNone;
  FootPlace place = FootPlace::kInside;
  std::uint8_t edge = 0;          // of the triangle, if the foot is on one
  bool at_border = false;         // the foot is on a forbidden edge or on a border
  dvec3 barycentric{1, 0, 0};     // [1]
  dvec3 p{0};                     // [m]
  dvec3 normal{0, 1, 0};          // [1] unit, outward: along x - p, or the surface's if x is on it
  double height = 0.0;            // [m] signed distance of x from p: < 0 behind the surface
  dmat3 moves{0.0};               // [1] dp/dx
  dmat3 turns{0.0};               // [1/m] dn/dx
  std::array<dvec3, 3> shifts{};  // [1/m] d barycentric_i / dx

  bool valid() const { return triangle != kNone; }
};

// The local minimum of the distance from x downhill of a place on the surface. `over_creases`: whether the descent may
// cross creases. Otherwise it ends at them, and the foot is the nearest point on the near side. The descent also ends
// at the edges `closed`, 3 * triangle + edge, ascending.
Foot descend(const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric, dvec3 x, bool over_creases = true,
             std::span<const std::uint32_t> closed = {});

}  // namespace pliant
