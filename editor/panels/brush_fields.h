// The fields of the paint brush.
#pragma once

#include "editor/core/painting.h"

namespace pliant {

inline constexpr float kPaintLabelShare = 0.30f;  // [1] of the panel's width

// A label at the left; the field follows at the right.
void paint_row(const char* label, const char* hint_text);
void draw_brush_fields(Painting& painting);

}  // namespace pliant
