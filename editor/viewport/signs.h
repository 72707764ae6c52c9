// What nodes without a surface look like in the editor: probes by their shape, lights, cameras by what they see, haptic
// devices; and the boxes that pin a body or make its handle.
#pragma once

#include <vector>

#include "editor/viewport/solid_view.h"

namespace pliant {

struct SignColors {
  vec4 plain{1}, selected{1}, pinned{1}, handle{1};  // encoded
};
// What has no size of its own is as large as the picture makes it easy to see. Appends lines, and nodes with a sign.
void add_signs(const SolidOrder& order, const std::vector<dmat4>& frames, const std::vector<bool>& shown,
               const std::vector<bool>& selected, const SignColors& colors, std::vector<ViewLine>& lines,
               std::vector<ViewSign>& signs);
inline constexpr vec4 kPinnedColor{0.36f, 0.66f, 0.95f, 1.0f}, kHandleColor{0.93f, 0.73f, 0.28f, 1.0f};  // encoded
// [1] colour of a painted value, 0 to 1, as shaders/editor_solid.frag has it.
vec3 ramp(float t);

}  // namespace pliant
