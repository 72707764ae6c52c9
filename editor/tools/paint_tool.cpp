// Painting with the mouse on the active node's mesh: drag paints, Shift smooths, Ctrl shows the value under the mouse.
// painting.h applies it to the document. GLFW 3.3 does not report a tablet's pressure: it counts as 1 until the window
// provides it (ViewportInput::pressure).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "editor/app/app.h"
#include "editor/core/painting.h"
#include "editor/tools/paint_cursor.h"
#include "editor/tools/paint_legend.h"
#include "editor/tools/tools.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr double kLookEvery = 0.2;  // [s] between checks whether the mesh under the mouse is too coarse

class PaintTool : public ViewTool {
 public:
  const char* name() const override { return "Paint"; }
  const char* sign() const override { return "P"; }
  const char* hint() const override {
    return hint_.empty() ? "Paint stiffness, friction and the like onto the selected mesh (P)" : hint_.c_str();
  }
  bool usable(const Editor& editor) const override {
    const DocumentNode* const node = editor.active_node();
    return node && node->node.mesh >= 0;
  }

  bool use(Editor& editor, const ViewportInput& in) override {
    Painting& painting = *editor.painting;
    if (taken_) {  // the click was already handled
      if (in.released || !in.held) taken_ = false;
      return true;
    }
    if (painting.stroking() && held_) {
      if (in.dx != 0 || in.dy != 0) painting.move(in.ray(), in.pressure);
      if (in.released) let_go(painting);
      return true;
    }
    if (!in.pressed) return false;
    const auto surface = painting.surface();
    if (!surface) return false;
    const SurfaceHit hit = painting.under(*surface, in.ray());
    if (!hit.valid() || hidden(painting, hit, in)) return false;
    press(editor, painting, *surface, hit, in);
    return true;
  }

  void overlay(Editor& editor, const ViewportInput& in, ImDrawList& list) override {
    Painting& painting = *editor.painting;
    if (!channel_before_) channel_before_ = editor.view.channel;
    editor.view.channel = painting.channel;
    if (held_ && !ImGui::IsMouseDown(0)) let_go(painting);  // if `use` was not called
    const bool escape = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
    if (escape && painting.stroking()) painting.give_up();
    if (escape) {
      painting.hand = Painting::Hand::kBrush;
      painting.gradient_start.reset();
    }
    draw_legend(editor, painting.channel,
                {in.corner.x + ui::px(ui::kPad), in.corner.y + static_cast<float>(in.height) - ui::px(36)}, list);
    if (!usable(editor)) {
      hint_ = "Paint: select a node with a mesh.";
      return;
    }
    painting.fit_radius();
    const auto surface = painting.surface();
    if (!surface) {
      hint_ = painting.preparing() ? "Paint: the surface is being prepared \u2026"
                                   : "Paint: this mesh cannot be painted; the console says why.";
      return;
    }
    hint_ = hint_of(painting);
    if (!in.over || in.alt) return;
    const SurfaceHit hit = painting.under(*surface, in.ray());
    if (!hit.valid()) return;
    look(editor, painting, hit);
    const bool free = !hidden(painting, hit, in);
    const bool click = painting.hand != Painting::Hand::kBrush || in.control;
    if (!click) {
      draw_ring(painting, *surface, hit, in, list, free ? 1.0f : 0.35f);
      if (const SurfaceHit other = painting.mirrored(*surface, hit); other.valid())
        draw_ring(painting, *surface, other, in, list, 0.45f);
    }
    if (painting.gradient_start) draw_gradient(painting, hit, in, list);
    std::string text;
    if (in.control)
      text =
          fmt::format("{} {}", text_of(painting.channel).title, painting.value_text(painting.value_at(*surface, hit)));
    else if (painting.hand == Painting::Hand::kFillPart)
      text = "Fill this part";
    else if (painting.hand == Painting::Hand::kGradientFrom)
      text = fmt::format("From {:.3g}", painting.gradient_from);
    else if (painting.hand == Painting::Hand::kGradientTo)
      text = fmt::format("To {:.3g}", painting.gradient_to);
    const bool coarse = text.empty() && painting.hover && painting.hover->surface == surface &&
                        painting.hover->coarse && painting.hover->radius == painting.brush.radius &&
                        length(painting.hover->hit.point - hit.point) < painting.brush.radius;
    if (coarse) text = fmt::format("too coarse here: edges of {:.3g} mm", 1e3 * painting.hover->coarse->edge);
    if (!text.empty()) say_at_mouse(in, list, text, coarse);
  }

  void leave(Editor& editor) override {
    Painting& painting = *editor.painting;
    if (held_) let_go(painting);
    painting.hand = Painting::Hand::kBrush;
    painting.gradient_start.reset();
    if (channel_before_) editor.view.channel = *channel_before_;
    channel_before_.reset();
    hint_.clear();
  }

 private:
  void let_go(Painting& painting) {
    painting.release();
    held_ = false;
  }

  void press(Editor& editor, Painting& painting, const PaintSurface& surface, const SurfaceHit& hit,
             const ViewportInput& in) {
    using Hand = Painting::Hand;
    taken_ = true;
    if (in.control) {
      painting.value_now() =
          static_cast<double>(clamp_paint(attribute_of(painting.channel), painting.value_at(surface, hit)));
      editor.say("The brush's value is now " + painting.value_text(painting.value_now()));
    } else if (painting.hand == Hand::kFillPart) {
      painting.fill_part(hit);
      painting.hand = Hand::kBrush;
    } else if (painting.hand == Hand::kGradientFrom) {
      painting.gradient_start = hit;
      painting.hand = Hand::kGradientTo;
    } else if (painting.hand == Hand::kGradientTo && painting.gradient_start) {
      painting.gradient(*painting.gradient_start, hit);
      painting.gradient_start.reset();
      painting.hand = Hand::kBrush;
    } else {
      taken_ = false;
      painting.press(in.ray(), in.pressure, in.shift ? BrushMode::kSmooth : painting.brush.mode);
      held_ = painting.stroking();
      painting.look_whether_coarse(hit, true);
    }
  }

  // Another object is in front: the click is for that.
  static bool hidden(const Painting& painting, const SurfaceHit& hit, const ViewportInput& in) {
    if (in.under == kNoNode || in.under == painting.node()) return false;
    const auto there = on_picture(in.view, in.orthographic, in.width, in.height, in.under_at);
    const auto here = on_picture(in.view, in.orthographic, in.width, in.height, hit.point + painting.corner());
    return there && here && std::hypot(there->x - in.x, there->y - in.y) < 3.0 && there->z < 0.999 * here->z;
  }

  std::string hint_of(const Painting& painting) const {
    if (painting.hand == Painting::Hand::kFillPart) return "Click the part to fill. Esc: no.";
    if (painting.hand == Painting::Hand::kGradientFrom) return "Click where the gradient begins. Esc: no.";
    if (painting.hand == Painting::Hand::kGradientTo) return "Click where the gradient ends. Esc: no.";
    return fmt::format(
        "Drag paints, Shift smooths, Ctrl shows the value, Ctrl click takes it, Alt turns the view. Radius {:.3g} mm "
        "[ ], strength {:.0f} % Shift [ ]",
        1e3 * painting.brush.radius, 100 * painting.brush.strength);
  }

  // In the background, while the mouse moves.
  void look(const Editor& editor, Painting& painting, const SurfaceHit& hit) {
    if (painting.stroking() || editor.now - looked_ < kLookEvery) return;
    const double radius = painting.brush.radius;
    if (looked_radius_ == radius && length(looked_at_ - hit.point) < 0.2 * radius) return;
    looked_ = editor.now;
    looked_at_ = hit.point;
    looked_radius_ = radius;
    painting.look_whether_coarse(hit, false);
  }

  std::string hint_;
  bool held_ = false, taken_ = false;
  double looked_ = -1.0, looked_radius_ = 0.0;
  dvec3 looked_at_{0};
  std::optional<std::optional<Channel>> channel_before_;  // the displayed channel before this tool was activated
};

}  // namespace

std::unique_ptr<ViewTool> make_paint_tool() {
  return std::make_unique<PaintTool>();
}

}  // namespace pliant
