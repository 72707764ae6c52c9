// Clicking selects (handled by the viewport); dragging with Ctrl selects by a frame.
#include <algorithm>
#include <cmath>

#include "editor/tools/tools.h"
#include "editor/viewport/frames.h"
#include "viewer/ui/theme.h"

namespace pliant {
namespace {

class SelectTool : public ViewTool {
 public:
  const char* name() const override { return "Select"; }
  const char* sign() const override { return "S"; }
  const char* hint() const override {
    return "Click selects, Shift adds, Ctrl drags a frame. Drag turns the view, Shift drag or middle shifts it, wheel "
           "zooms.";
  }

  bool use(Editor& editor, const ViewportInput& in) override {
    if (in.pressed && in.control) {
      framing_ = true;
      x_ = in.x;
      y_ = in.y;
    }
    if (!framing_) return false;
    if (!in.released) return true;
    framing_ = false;
    if (std::hypot(in.x - x_, in.y - y_) < 4.0) return false;  // a click
    editor.selected.clear();
    const std::vector<dmat4> frames = world_frames(editor.state());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const auto at = on_picture(in.view, in.orthographic, in.width, in.height, dvec3(frames[i][3]));
      const DocumentNode& node = *editor.state().nodes[i];
      dvec3 middle(frames[i][3]);
      if (node.node.mesh >= 0) {
        const Box& box = editor.state().meshes[static_cast<std::size_t>(node.node.mesh)]->box;
        if (!box.empty()) middle = dvec3(frames[i] * glm::dvec4(dvec3(box.center()), 1.0));
      }
      const auto center = on_picture(in.view, in.orthographic, in.width, in.height, middle);
      const auto inside = [&](const std::optional<dvec3>& p) {
        return p && p->x >= std::min(x_, in.x) && p->x <= std::max(x_, in.x) && p->y >= std::min(y_, in.y) &&
               p->y <= std::max(y_, in.y);
      };
      if (node.node.in_scene && (inside(center) || (node.node.mesh < 0 && inside(at))))
        editor.selected.push_back(node.id);
    }
    return true;
  }

  void overlay(Editor&, const ViewportInput& in, ImDrawList& list) override {
    if (!framing_) return;
    const ImVec2 a(in.corner.x + static_cast<float>(x_), in.corner.y + static_cast<float>(y_)),
        b(in.corner.x + static_cast<float>(in.x), in.corner.y + static_cast<float>(in.y));
    list.AddRectFilled(a, b, ui::color(ui::palette().accent, 0.15f));
    list.AddRect(a, b, ui::color(ui::palette().accent), 0, 0, ui::px(1));
  }

 private:
  bool framing_ = false;
  double x_ = 0, y_ = 0;  // [pixel] where the frame began
};

}  // namespace

std::unique_ptr<ViewTool> make_select_tool() {
  return std::make_unique<SelectTool>();
}

}  // namespace pliant
