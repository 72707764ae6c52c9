// Settings of a brush, and the falloff of its effect with the distance along the surface.
#pragma once

#include <algorithm>
#include <cstdint>

#include "editor/paint/paint_surface.h"
#include "runtime/assert.h"

namespace pliant {

enum class BrushFalloff : std::uint8_t { kConstant, kLinear, kSmooth, kSharp };
enum class BrushMode : std::uint8_t {
  kSet,     // towards `value`; repeated passes in one stroke go no farther than `strength`
  kAdd,     // every dab adds `value` at full weight; below 0 it subtracts
  kSmooth,  // every dab moves values towards the neighbours' mean
  kErase    // as kSet, towards the unpainted value
};
enum class BrushMirror : std::uint8_t { kNone, kX, kY, kZ };  // of the mesh frame, through its origin

struct Brush {
  double radius = 0.01;   // [m] along the surface, in the world
  double strength = 1.0;  // [1] 0 to 1
  BrushFalloff falloff = BrushFalloff::kSmooth;
  BrushMode mode = BrushMode::kSet;
  double value = 1.0;  // [1] clamped to paint_range(); for kAdd the result is clamped
  BrushMirror mirror = BrushMirror::kNone;
  PaintMask mask;
  bool both_sides = false;  // PaintSurface::hit
};

inline constexpr double kDabSpacing = 0.25;  // [1] of the radius: closer dabs look the same

// Share of the strength at a distance of `away` [1] radii: 1 at the centre. kSmooth has zero slope at both ends.
inline double falloff_at(BrushFalloff falloff, double away) {
  const double near = 1.0 - std::clamp(away, 0.0, 1.0);
  switch (falloff) {
    case BrushFalloff::kConstant:
      return away <= 1.0 ? 1.0 : 0.0;
    case BrushFalloff::kLinear:
      return near;
    case BrushFalloff::kSmooth:
      return near * near * (3.0 - 2.0 * near);
    case BrushFalloff::kSharp:
      return near * near;
  }
  UNREACHABLE();
}

}  // namespace pliant
