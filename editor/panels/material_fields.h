// The material of an object's part: its look, its textures, and tissue presets.
#pragma once

#include "editor/core/editor.h"

namespace pliant {

// `search`: only rows that it finds; `part`: of its mesh, the one that is shown.
void draw_material_fields(Editor& editor, const DocumentNode& node, const std::string& search, std::size_t& part);
// Takes a preset's stiffness, damping and friction, and its look where the node has no material.
Status take_preset(Level& level, std::int32_t node, const struct TissuePreset& preset);

}  // namespace pliant
