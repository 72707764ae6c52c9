// Shared by the tools Move, Turn and Scale: handles of constant screen size, dragged with the mouse or set by typing. A
// drag is one step of the document, and shown at once.
#pragma once

#include "editor/core/panel.h"
#include "editor/core/settings.h"
#include "editor/viewport/gizmo_math.h"

namespace pliant {

GizmoPicture picture_of(const ViewportInput& in);

class GizmoTool : public ViewTool {
 public:
  explicit GizmoTool(Settings& settings) : settings_(settings) {}
  bool usable(const Editor& editor) const override { return !editor.playing; }
  bool use(Editor& editor, const ViewportInput& in) override;
  void overlay(Editor& editor, const ViewportInput& in, ImDrawList& list) override;
  void leave(Editor& editor) override;
  bool wants_keys() const override { return dragging_ || typing_; }
  bool has_options() const override { return true; }
  void options(Editor& editor) override;

  Pivot pivot = Pivot::kMiddle;  // pivot of the motion

 protected:
  // The effect of a handle: displacement, angle (x), or factors. Empty: the mouse gives no valid value.
  virtual std::optional<dvec3> dragged(Editor& editor, const ViewportInput& in, bool snap) = 0;
  virtual dvec3 typed_amounts(GizmoPart part, double value) = 0;
  virtual std::vector<Placing> placings(dvec3 amounts) const = 0;
  virtual std::string readout(dvec3 amounts) const = 0;
  virtual GizmoPart pick(const GizmoPicture& picture, const GizmoGrip& grip, dvec2 mouse) const = 0;
  virtual void draw(const GizmoPicture& picture, const GizmoGrip& grip, ImVec2 corner, ImDrawList& list,
                    GizmoPart bright) const = 0;
  virtual bool lengths() const { return false; }  // typed values are lengths
  virtual void begun(Editor&) {}
  virtual double& snap_step() = 0;
  virtual const char* snap_unit() const = 0;
  virtual void more_options(Editor&) {}

  Settings& settings_;
  GizmoGrip grip_;                     // during a drag: the initial state
  GizmoPart part_ = GizmoPart::kNone;  // the dragged part
  dvec2 from_{0}, last_{0};            // [pixel] start of the drag, and the mouse in the last frame

 private:
  void begin(Editor& editor, GizmoPart part, const ViewportInput& in);
  void show(Editor& editor);
  void finish(Editor& editor, bool keep);
  void take_text(Editor& editor, const ViewportInput& in);

  bool dragging_ = false, typing_ = false;
  GizmoPart hovered_ = GizmoPart::kNone;
  dvec3 amounts_{0};
  bool any_ = false;  // `amounts_` is valid
  std::string text_;  // typed
  bool understood_ = true;
  int gestures_ = 0;
  std::string gesture_;
};

// Parts of gizmos: drawing and picking. Sizes in points.
namespace gizmo {
inline constexpr float kLength = 92, kPlaneNear = 26, kPlaneFar = 42, kCenter = 9, kReach = 8, kRing = 84;
// [m] of one point at the grip's pivot; empty: behind the eye.
std::optional<double> unit(const GizmoPicture& picture, const GizmoGrip& grip);
ImU32 color_of(GizmoPart part, bool bright, float alpha = 1.0f);
// [1] 0 if an axis points at the eye, or a plane is edge-on: such a part is not drawn.
float clarity(const GizmoPicture& picture, const GizmoGrip& grip, GizmoPart part);
// Axes, planes and centre, for Move and Scale.
GizmoPart pick_arrows(const GizmoPicture& picture, const GizmoGrip& grip, dvec2 mouse);
void draw_arrows(const GizmoPicture& picture, const GizmoGrip& grip, ImVec2 corner, ImDrawList& list, GizmoPart bright,
                 bool boxes);
void letter(ImDrawList& list, ImVec2 at, int axis, ImU32 color);
}  // namespace gizmo

}  // namespace pliant
