// The moving part of a Deformable: per vertex the stream (nx, ny, nz, h) that any shader can draw, and the residual
// that is still on its way back to rest.
//
// While a probe holds the surface the field *follows*: stream = target + residual, where the target is the contacts'
// shape and the residual is what earlier presses left behind. On release the target is folded into the residual, which
// then obeys m h'' + b h' + F(h) = 0 by the exact step (methods.md 1.1, 1.8). With Response::kLag there is no such
// split: residual is the whole state and the target acts as a force (P1 as printed).
//
// Rate: touch. Writer: force_field and dynamics. Sized at preparation; padded to whole zones like the mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "components/math.h"

namespace pliant {

struct HeightField {
  std::vector<vec4> stream;    // [1,1,1,m] added to N0, and along N0
  std::vector<vec4> residual;  // [1,1,1,m]
  std::vector<vec4> rate;      // [1/s,1/s,1/s,m/s] of the residual
  // Standard linear solid only, else empty: the tissue remembers where it was pressed (methods.md 1.2).
  std::vector<vec4> arm;      // [m] of the residual: force of the arm over k
  std::vector<vec4> relaxed;  // [1,1,1,m] viscous extension under the targets: where the arm's damper has crept to

  std::vector<std::uint8_t> zone_state;  // per zone: bits of ZoneBit
  std::vector<std::uint32_t> awake;      // zones whose stream may change this tick (capacity: all zones)
  std::uint32_t awake_vertices = 0;
};

// Why a zone is awake.
enum ZoneBit : std::uint8_t {
  kZoneReached = 1,   // a contact's field reaches it this tick
  kZoneResidual = 2,  // its residual has not come to rest
  kZoneListed = 4,    // it stands in HeightField::awake
  kZoneDirty = 8,     // its stream changed since it was last published
};

}  // namespace pliant
