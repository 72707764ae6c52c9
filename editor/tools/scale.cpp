// Scale: along an axis, in a plane, or as a whole by the middle.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "editor/tools/gizmo.h"
#include "editor/tools/tools.h"

namespace pliant {
namespace {

constexpr double kLeastSnapped = 1e-3;  // [1] snapping never flattens a node

class ScaleTool : public GizmoTool {
 public:
  using GizmoTool::GizmoTool;
  const char* name() const override { return "Scale"; }
  const char* sign() const override { return "C"; }
  const char* hint() const override {
    return "Drag an axis, a square, or the middle for all three; Ctrl turns snapping round. Or type: 2 while dragging, "
           "or x 2 Enter.";
  }

 protected:
  std::optional<dvec3> dragged(Editor&, const ViewportInput& in, bool snap) override {
    auto by = scaled_by(picture_of(in), grip_, part_, from_, {in.x, in.y});
    if (by && snap)
      for (int i = 0; i < 3; ++i)
        (*by)[i] = std::max(1.0 + snapped((*by)[i] - 1.0, settings_.snap_scale), kLeastSnapped);
    return by;
  }
  dvec3 typed_amounts(GizmoPart part, double value) override {
    if (part == GizmoPart::kFree) return dvec3(value);
    dvec3 by(1);
    if (is_axis(part))
      by[axis_of(part)] = value;
    else
      by[(axis_of(part) + 1) % 3] = by[(axis_of(part) + 2) % 3] = value;
    return by;
  }
  std::vector<Placing> placings(dvec3 by) const override { return scaled(grip_, by); }
  std::string readout(dvec3 by) const override {
    if (is_axis(part_)) return fmt::format("{}  \u00d7 {:.4g}", "xyz"[axis_of(part_)], by[axis_of(part_)]);
    return fmt::format("\u00d7 {:.4g}", is_plane(part_) ? by[(axis_of(part_) + 1) % 3] : by.x);
  }
  GizmoPart pick(const GizmoPicture& picture, const GizmoGrip& grip, dvec2 mouse) const override {
    return gizmo::pick_arrows(picture, grip, mouse);
  }
  void draw(const GizmoPicture& picture, const GizmoGrip& grip, ImVec2 corner, ImDrawList& list,
            GizmoPart bright) const override {
    gizmo::draw_arrows(picture, grip, corner, list, bright, true);
  }
  double& snap_step() override { return settings_.snap_scale; }
  const char* snap_unit() const override { return ""; }
};

}  // namespace

std::unique_ptr<ViewTool> make_scale_tool(Settings& settings) {
  return std::make_unique<ScaleTool>(settings);
}

}  // namespace pliant
