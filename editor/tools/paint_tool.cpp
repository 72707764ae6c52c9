// Painting with the mouse on the active node's mesh: drag paints, Shift smooths, Ctrl shows the value under the mouse.
// painting.h applies it to the document. GLFW 3.3 does not report a tablet's pressure: it counts as 1 until the window
// provides it (ViewportInput::pressure).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "editor/app/app.h"
#include "editor/tools/paint_legend.h"
#include "editor/tools/painting.h"
#include "editor/tools/tools.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr int kRingPoints = 56;
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
      ring(painting, *surface, hit, in, list, free ? 1.0f : 0.35f);
      if (const SurfaceHit other = painting.mirrored(*surface, hit); other.valid())
        ring(painting, *surface, other, in, list, 0.45f);
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

  // The brush's rim: a circle in the tangent plane, laid onto the surface.
  static void ring(const Painting& painting, const PaintSurface& surface, const SurfaceHit& hit,
                   const ViewportInput& in, ImDrawList& list, float strength) {
    const dvec3 n = hit.normal, side = std::abs(n.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 a = normalize(cross(n, side)), b = cross(n, a), corner = painting.corner();
    const auto on_screen = [&](const dvec3& place) -> std::optional<ImVec2> {
      const auto p = on_picture(in.view, in.orthographic, in.width, in.height, place + corner);
      if (!p) return {};
      return ImVec2(in.corner.x + static_cast<float>(p->x), in.corner.y + static_cast<float>(p->y));
    };
    const dvec3 forward = normalize(in.view.target - in.view.eye);
    std::vector<std::pair<std::optional<ImVec2>, bool>> points;  // and whether it is on the side that is seen
    const double r = painting.brush.radius;
    for (int k = 0; k <= kRingPoints; ++k) {
      const double t = 2.0 * std::numbers::pi * k / kRingPoints;
      const dvec3 flat = hit.point + r * (std::cos(t) * a + std::sin(t) * b);
      const SurfaceHit on = surface.closest(flat, 0.75 * r);
      if (on.valid() && dot(on.normal, n) > -0.2)
        points.emplace_back(on_screen(on.point), dot(on.normal, forward) * dot(n, forward) > 0.0);
      else
        points.emplace_back(on_screen(flat), true);
    }
    const ImU32 dark = ImGui::GetColorU32(ImVec4(0, 0, 0, 0.55f * strength)),
                light = ImGui::GetColorU32(ImVec4(1, 1, 1, 0.95f * strength)),
                far = ImGui::GetColorU32(ImVec4(1, 1, 1, 0.25f * strength));
    for (const bool over : {false, true})
      for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const auto& [from, seen] = points[k];
        const auto& [to, seen_too] = points[k + 1];
        if (!from || !to) continue;
        const bool near = seen && seen_too;
        if (!over && near) list.AddLine(*from, *to, dark, ui::px(3.5f));
        if (over) list.AddLine(*from, *to, near ? light : far, ui::px(1.5f));
      }
    if (const auto middle = on_screen(hit.point)) {
      list.AddCircleFilled(*middle, ui::px(3), dark);
      list.AddCircleFilled(*middle, ui::px(2), light);
    }
  }

  static void draw_gradient(const Painting& painting, const SurfaceHit& hit, const ViewportInput& in,
                            ImDrawList& list) {
    const auto from = on_picture(in.view, in.orthographic, in.width, in.height,
                                 painting.gradient_start->point + painting.corner()),
               to = on_picture(in.view, in.orthographic, in.width, in.height, hit.point + painting.corner());
    if (!from || !to) return;
    const ImVec2 a(in.corner.x + static_cast<float>(from->x), in.corner.y + static_cast<float>(from->y)),
        b(in.corner.x + static_cast<float>(to->x), in.corner.y + static_cast<float>(to->y));
    list.AddLine(a, b, ImGui::GetColorU32(ImVec4(0, 0, 0, 0.55f)), ui::px(4));
    list.AddLine(a, b, ImGui::GetColorU32(ImVec4(1, 1, 1, 0.95f)), ui::px(2));
    list.AddCircleFilled(a, ui::px(4), ui::color(ui::palette().accent));
  }

  static void say_at_mouse(const ViewportInput& in, ImDrawList& list, const std::string& text, bool warns) {
    const ui::Palette& p = ui::palette();
    const ImVec2 size = ImGui::CalcTextSize(text.c_str()), pad(ui::px(8), ui::px(4));
    ImVec2 at(in.corner.x + static_cast<float>(in.x) + ui::px(18), in.corner.y + static_cast<float>(in.y) + ui::px(14));
    at.x = std::min(at.x, in.corner.x + static_cast<float>(in.width) - size.x - 3 * pad.x);
    at.y = std::min(at.y, in.corner.y + static_cast<float>(in.height) - size.y - 3 * pad.y);
    list.AddRectFilled({at.x - pad.x, at.y - pad.y}, {at.x + size.x + pad.x, at.y + size.y + pad.y},
                       ui::color(p.raised, 0.92f), ui::px(4));
    list.AddText(at, ui::color(warns ? p.warning : p.text), text.c_str());
    ui::known_at("At the mouse", {at.x - pad.x, at.y - pad.y}, {at.x + size.x + pad.x, at.y + size.y + pad.y});
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
