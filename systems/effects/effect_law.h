// The law of an effect on one tip of a probe, in the effect's frame. Potentials and their derivatives are exact
// (methods.md 1.13): force = -dU/dx, stiffness = d2U/dx2.
#pragma once

#include <cstdint>

#include "components/effect.h"
#include "components/math.h"

namespace pliant {

class GuidePath;

// A place on the path of a guidance.
struct PathFoot {
  std::uint32_t segment = 0;
  double along = 0.0;  // [m]
};

struct EffectValue {
  double energy = 0.0;   // [J] U >= 0
  dvec3 force{0};        // [N]
  dmat3 stiffness{0.0};  // [N/m]
  double damping = 0.0;  // [N s/m] of a drag against the velocity
};

// Memory of a kind, per tip. A change of it never raises U, so that no energy is made.
struct EffectMemory {
  bool begun = false;     // the rest means something
  dvec3 last{0};          // [m] last tick's place
  double energy = 0.0;    // [J] last tick's
  bool inside = false;    // of what is forbidden
  dvec3 side{0};          // [1] forbidden: direction to the surface where the tip came in
  double unpushed = 0.0;  // [m] depth in which it began, which does not push
  bool guided = false;    // a foot on the path is known
  PathFoot foot, other;   // and the one that it goes over to
  double over = 0.0;      // [1] share of the other; 0: there is none
};

struct EffectInput {
  const Effect& effect;
  const GuidePath* path = nullptr;  // of a guidance
  dvec3 x{0};                       // [m] the tip's centre
  dvec3 before{0};                  // [m] where it came from in this tick
  double radius = 0.0;              // [m] of the tip
  double dt = 1e-3;                 // [s]
};

// effect_<word>: one file each.
#define PLIANT_DECLARE(enumerator, word, tips, reads) \
  EffectValue effect_##word(const EffectInput& in, EffectMemory& memory);
PLIANT_EFFECTS(PLIANT_DECLARE)
#undef PLIANT_DECLARE

inline EffectValue effect_value(const EffectInput& in, EffectMemory& memory) {
  using Law = EffectValue (*)(const EffectInput&, EffectMemory&);
  constexpr Law kLaws[] = {
#define PLIANT_LAW(enumerator, word, tips, reads) effect_##word,
      PLIANT_EFFECTS(PLIANT_LAW)
#undef PLIANT_LAW
  };
  return kLaws[static_cast<std::size_t>(in.effect.kind)](in, memory);
}

// Region's weight, 0 outside, 1 deeper than `edge` (or in the middle), twice differentiable but at those depths.
struct RegionWeight {
  double value = 0.0;
  dvec3 slope{0};        // [1/m]
  dmat3 curvature{0.0};  // [1/m2]
};
RegionWeight region_weight(const Effect& effect, dvec3 x);

// U w, of a potential U and a region's weight w.
EffectValue weighted(const EffectValue& value, const RegionWeight& weight);

// U = D (1 - (1 - q)^3), q = |v|^2 / R^2, D = k R^2 / 6, for v from the nearest point of a set; `moves` = dv/dx. Beyond
// R: U = D. Its force k |v| (1 - q)^2 is at most 16 / (25 sqrt 5) k R, at R / sqrt 5.
EffectValue well(const Effect& effect, dvec3 v, const dmat3& moves);

}  // namespace pliant
