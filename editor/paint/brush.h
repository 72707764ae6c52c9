// A brush as its settings, and how its effect falls off with the way along the surface.
#pragma once

#include <algorithm>
#include <cstdint>

#include "editor/paint/paint_surface.h"
#include "runtime/assert.h"

namespace pliant {

enum class BrushFalloff : std::uint8_t { kConstant, kLinear, kSmooth, kSharp };
enum class BrushMode : std::uint8_t {
  kSet,     // towards `value`; going over a place again in one stroke takes it no farther than `strength`
  kAdd,     // `value` is added by every dab, at full weight; below 0 it takes away
  kSmooth,  // towards the mean of the neighbours, with every dab
  kErase    // as kSet, towards what is unpainted
};
enum class BrushMirror : std::uint8_t { kNone, kX, kY, kZ };  // of the mesh frame, through its origin

struct Brush {
  double radius = 0.01;   // [m] along the surface, in the world
  double strength = 1.0;  // [1] 0 to 1
  BrushFalloff falloff = BrushFalloff::kSmooth;
  BrushMode mode = BrushMode::kSet;
  double value = 1.0;  // [1] clamped to paint_range(); for kAdd what it leads to is
  BrushMirror mirror = BrushMirror::kNone;
  PaintMask mask;
  bool both_sides = false;  // PaintSurface::hit
};

inline constexpr double kDabSpacing = 0.25;  // [1] of the radius: closer dabs are not told apart

// Share of the strength at a distance of `away` [1] radii: 1 at the middle. kSmooth leaves both ends level.
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
