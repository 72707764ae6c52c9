// A paddle of tissue with a rigid handle on its upper face, pressed on a bed of studs and moved in circles there with
// friction: one contact per stud, however fine the tissue.
#pragma once

#include "scenes/tool_stage.h"

namespace pliant::scenes {

// Cells of the paddle: six tetrahedra each.
struct PaddleCells {
  int along, high, across;
  int tetrahedra() const { return 6 * along * high * across; }
};
// Studs in rows on so many grounds side by side: two bodies have 60 contacts at most.
struct StudBed {
  int grounds, along, across;
  int count() const { return grounds * along * across; }
};

// 540, 2,016, 10,080 and 40,128 tetrahedra; studs for about 10, 30, 60 and 200 contacts: some touch an edge too.
inline constexpr PaddleCells kPaddles[]{{9, 2, 5}, {14, 3, 8}, {24, 5, 14}, {38, 8, 22}};
inline constexpr StudBed kBeds[]{{1, 3, 3}, {1, 9, 3}, {2, 3, 9}, {6, 4, 7}};
inline constexpr PaddleCells kUsualPaddle = kPaddles[1];
inline constexpr StudBed kUsualBed = kBeds[2];

inline constexpr double kPaddlePressed = 0.3;       // [s] by when it is pressed in
inline constexpr dvec3 kPaddleStart{0, 0.5e-3, 0};  // [m] above the studs

// The tool.
Entity add_paddle(ToolStage& stage, PaddleCells cells);
void add_bed(ToolStage& stage, StudBed bed);
// Path of its device. [m]
dvec3 paddle_path(double time);

}  // namespace pliant::scenes
