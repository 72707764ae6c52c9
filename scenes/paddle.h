// A tissue paddle whose upper face is a rigid handle. It is pressed on a bed of studs and moved in circles with
// friction: one contact per stud, at any resolution of the tissue.
#pragma once

#include "scenes/tool_stage.h"

namespace pliant::scenes {

// Cells of the paddle: six tetrahedra each.
struct PaddleCells {
  int along, high, across;
  int tetrahedra() const { return 6 * along * high * across; }
};
// Studs in rows on `grounds` adjacent grounds: two bodies have at most 60 contacts.
struct StudBed {
  int grounds, along, across;
  int count() const { return grounds * along * across; }
};

// 540, 2,016, 10,080 and 40,128 tetrahedra; studs for about 10, 30, 60 and 200 contacts: some also touch an edge.
inline constexpr PaddleCells kPaddles[]{{9, 2, 5}, {14, 3, 8}, {24, 5, 14}, {38, 8, 22}};
inline constexpr StudBed kBeds[]{{1, 3, 3}, {1, 9, 3}, {2, 3, 9}, {6, 4, 7}};
inline constexpr PaddleCells kUsualPaddle = kPaddles[1];
inline constexpr StudBed kUsualBed = kBeds[2];

inline constexpr double kPaddlePressed = 0.3;       // [s] time at which it is pressed in
inline constexpr dvec3 kPaddleStart{0, 0.5e-3, 0};  // [m] above the studs

// Adds the tool.
Entity add_paddle(ToolStage& stage, PaddleCells cells);
void add_bed(ToolStage& stage, StudBed bed);
// [m] Prescribed position of its device.
dvec3 paddle_path(double time);

}  // namespace pliant::scenes
