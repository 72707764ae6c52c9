// Symbols for nodes without a surface: probes, lights, cameras, haptic devices, effects; and boxes for pins and
// handles.
#pragma once

#include <vector>

#include "editor/viewport/solid_view.h"

namespace pliant {

struct SignColors {
  vec4 plain{1}, selected{1}, pinned{1}, handle{1};  // encoded
};
// Nodes without a size get a constant size on screen. Appends lines, and nodes with a symbol.
void add_signs(const SolidOrder& order, const std::vector<dmat4>& frames, const std::vector<bool>& shown,
               const std::vector<bool>& selected, const SignColors& colors, std::vector<ViewLine>& lines,
               std::vector<ViewSign>& signs);
inline constexpr vec4 kPinnedColor{0.36f, 0.66f, 0.95f, 1.0f}, kHandleColor{0.93f, 0.73f, 0.28f, 1.0f};  // encoded

}  // namespace pliant
