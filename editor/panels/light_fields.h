// The fields of a node's light and of its camera; nothing where it has none.
#pragma once

#include "editor/core/panel.h"

namespace pliant {

void draw_light_fields(Editor& editor, const DocumentNode& node);
void draw_camera_fields(Editor& editor, const DocumentNode& node);

}  // namespace pliant
