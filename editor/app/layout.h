// Places of the bars, panels and edges in a window.
#pragma once

namespace pliant {

inline constexpr float kTopBar = 40, kBottomBar = 26;  // [point]
inline constexpr float kTopRow = 32;                   // [point] of a second row of the top bar

struct Layout {
  double wide_left = 0.0, wide_right = 0.0, high_bottom = 0.0;  // [point]
  float left = 0, right = 0, top = 0, bar = 0, bottom = 0;      // [pixel] edges of the viewport, and the bar
  float seam = 0;                                               // [pixel] of an edge that moves
};

}  // namespace pliant
