// The moving part of a Deformable: per vertex the stream (nx, ny, nz, h), which a shader can draw, and the residual
// that is still recovering.
//
// While a probe presses, the field *follows*: stream = target + residual. The target is the contacts' shape; the
// residual is left over from earlier presses. On release the target is folded into the residual, which then obeys m h''
// + b h' + F(h) = 0 by the exact step (methods.md 1.1, 1.8). With Response::kLag there is no such split: the residual
// is the whole state and the target acts as a force (P1 as printed).
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
  // Standard linear solid only, else empty: the viscoelastic memory of earlier presses (methods.md 1.2).
  std::vector<vec4> arm;      // [m] of the residual: force of the arm over k
  std::vector<vec4> relaxed;  // [1,1,1,m] viscous extension under the targets: creep of the arm's damper

  // Of a surface that yields, else empty: the dents that stay, part of the stream. Written by friction_feedback.
  std::vector<vec4> set;  // [1,1,1,m]

  std::vector<std::uint8_t> zone_state;  // per zone: bits of ZoneBit
  std::vector<std::uint32_t> awake;      // zones whose stream may change this tick (capacity: all zones)
  std::uint32_t awake_vertices = 0;
};

// Why a zone is awake.
enum ZoneBit : std::uint8_t {
  kZoneReached = 1,   // a contact's field reaches it this tick
  kZoneResidual = 2,  // its residual has not come to rest
  kZoneListed = 4,    // it is listed in HeightField::awake
  kZoneDirty = 8,     // its stream changed since it was last published
};

}  // namespace pliant
