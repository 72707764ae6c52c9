// Move: along an axis, in a plane, in the picture's plane; with Shift along the surface under the mouse.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "editor/tools/gizmo.h"
#include "editor/tools/surface_under.h"
#include "editor/tools/tools.h"
#include "editor/viewport/frames.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

class MoveTool : public GizmoTool {
 public:
  using GizmoTool::GizmoTool;
  const char* name() const override { return "Move"; }
  const char* sign() const override { return "M"; }
  const char* hint() const override {
    return "Drag an arrow, a square or the middle; Shift follows the surface under the mouse, Ctrl turns snapping "
           "round. "
           "Or type: x 5mm Enter.";
  }

 protected:
  std::optional<dvec3> dragged(Editor& editor, const ViewportInput& in, bool snap) override {
    waits_ = false;
    if (in.shift) {
      const SurfaceUnder under = surface_under(editor, in.ray(), editor.selected);
      waits_ = under.waits;
      if (!under.point) return {};
      return glm::inverse(grip_.axes) * (*under.point - held_point_);
    }
    auto by = moved_by(picture_of(in), grip_, part_, from_, {in.x, in.y});
    if (by && snap)
      for (int i = 0; i < 3; ++i) (*by)[i] = snapped((*by)[i], settings_.snap_move);
    return by;
  }
  dvec3 typed_amounts(GizmoPart part, double value) override {
    dvec3 by(0);
    if (is_axis(part))
      by[axis_of(part)] = value;
    else if (is_plane(part))
      by[(axis_of(part) + 1) % 3] = by[(axis_of(part) + 2) % 3] = value;
    else
      by.x = value;
    return by;
  }
  std::vector<Placing> placings(dvec3 by) const override { return moved(grip_, grip_.axes * by); }
  std::string readout(dvec3 by) const override {
    if (waits_) return "preparing the surface under the mouse";
    if (is_axis(part_)) return fmt::format("{}  {}", "xyz"[axis_of(part_)], metres_text(by[axis_of(part_)]));
    std::string text;
    for (int i = 0; i < 3; ++i)
      if (!is_plane(part_) || i != axis_of(part_))
        text += fmt::format("{}{}  {}", text.empty() ? "" : "   ", "xyz"[i], metres_text(by[i], 3));
    return text;
  }
  GizmoPart pick(const GizmoPicture& picture, const GizmoGrip& grip, dvec2 mouse) const override {
    return gizmo::pick_arrows(picture, grip, mouse);
  }
  void draw(const GizmoPicture& picture, const GizmoGrip& grip, ImVec2 corner, ImDrawList& list,
            GizmoPart bright) const override {
    gizmo::draw_arrows(picture, grip, corner, list, bright, false);
  }
  bool lengths() const override { return true; }
  void begun(Editor& editor) override {
    const auto active = std::find_if(grip_.held.begin(), grip_.held.end(),
                                     [&](const GizmoGrip::Held& held) { return held.id == editor.active(); });
    held_point_ = active == grip_.held.end() ? grip_.held.front().place : active->place;
    if (lowest_) held_point_ = lowest_point(editor.state(), editor.selected).value_or(held_point_);
  }
  double& snap_step() override { return settings_.snap_move; }
  const char* snap_unit() const override { return "m"; }
  void more_options(Editor&) override {
    ui::beside(ui::kPad, "Lowest point", 20);
    ui::checkbox("Lowest point", lowest_,
                 "With Shift, what is held follows the surface with its lowest point instead of its origin.");
  }

 private:
  bool lowest_ = false, waits_ = false;
  dvec3 held_point_{0};  // [m] world, where it was: what follows a surface
};

}  // namespace

std::unique_ptr<ViewTool> make_move_tool(Settings& settings) {
  return std::make_unique<MoveTool>(settings);
}

}  // namespace pliant
