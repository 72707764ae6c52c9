// Overlay of the picture: the tool's options at the upper left, overlays, standard views and the axis cross at the
// upper right, the grid's unit and the legend below, names of nodes.
#pragma once

#include <imgui.h>

#include "editor/core/panel.h"
#include "editor/viewport/stage.h"

namespace pliant {

class ViewBar {
 public:
  // Windows over the viewport from `low` to `high` [pixel].
  void draw(Editor& editor, ViewTool* tool, ImVec2 low, ImVec2 high);
  // Non-interactive parts, into the viewport's draw list.
  static void draw_over(const Editor& editor, const ViewportInput& in, ImDrawList& list);

 private:
  void draw_overlays(Editor& editor);
  static void draw_clip(Editor& editor);
  static void draw_cross(Editor& editor);
};

}  // namespace pliant
