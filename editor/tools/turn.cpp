// Turn: about an axis by its ring, about the view direction by the outer ring.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "editor/tools/gizmo.h"
#include "editor/tools/tools.h"
#include "viewer/ui/theme.h"

namespace pliant {
namespace {

constexpr int kPieces = 64;
constexpr float kOuter = 1.18f;  // [1] of the inner rings' radius

class TurnTool : public GizmoTool {
 public:
  using GizmoTool::GizmoTool;
  const char* name() const override { return "Turn"; }
  const char* sign() const override { return "T"; }
  const char* hint() const override {
    return "Drag a ring, the outer one to turn in the picture; Ctrl turns snapping round. Or type: z 90 Enter.";
  }

 protected:
  void begun(Editor&) override {
    turned_ = 0.0;
    axis_ = dvec3(0);
  }
  std::optional<dvec3> dragged(Editor&, const ViewportInput& in, bool snap) override {
    const GizmoPicture picture = picture_of(in);
    if (axis_ == dvec3(0)) axis_ = axis(picture, grip_, part_);
    const double radius =
        static_cast<double>(ui::px(gizmo::kRing)) * (part_ == GizmoPart::kFree ? double(kOuter) : 1.0);
    turned_ += turned_by(picture, grip_.pivot, axis_, last_, {in.x, in.y}, radius);
    return dvec3(snap ? glm::radians(snapped(glm::degrees(turned_), settings_.snap_turn)) : turned_, 0, 0);
  }
  dvec3 typed_amounts(GizmoPart part, double value) override {
    if (is_axis(part) || axis_ == dvec3(0)) axis_ = grip_.axes[is_axis(part) ? axis_of(part) : 2];
    return {glm::radians(value), 0, 0};
  }
  std::vector<Placing> placings(dvec3 by) const override { return turned(grip_, axis_, by.x); }
  std::string readout(dvec3 by) const override {
    const std::string about = is_axis(part_) ? std::string(1, "xyz"[axis_of(part_)]) + "  " : "";
    return fmt::format("{}{:.4g}\u00b0", about, glm::degrees(by.x));
  }
  GizmoPart pick(const GizmoPicture& picture, const GizmoGrip& grip, dvec2 mouse) const override {
    GizmoPart found = GizmoPart::kNone;
    double nearest = static_cast<double>(ui::px(gizmo::kReach));
    for (const GizmoPart part : {GizmoPart::kX, GizmoPart::kY, GizmoPart::kZ, GizmoPart::kFree}) {
      each_piece(picture, grip, part, [&](dvec3 a, dvec3 b, bool front) {
        if (!front) return;
        const dvec2 p(a), way = dvec2(b) - p;
        const double square = dot(way, way), s = square > 0 ? std::clamp(dot(mouse - p, way) / square, 0.0, 1.0) : 0.0;
        if (const double away = length(mouse - p - s * way); away < nearest) {
          nearest = away;
          found = part;
        }
      });
    }
    return found;
  }
  void draw(const GizmoPicture& picture, const GizmoGrip& grip, ImVec2 corner, ImDrawList& list,
            GizmoPart bright) const override {
    for (const bool behind : {true, false})
      for (const GizmoPart part : {GizmoPart::kFree, GizmoPart::kX, GizmoPart::kY, GizmoPart::kZ}) {
        const bool on = bright == part;
        each_piece(picture, grip, part, [&](dvec3 a, dvec3 b, bool front) {
          if (front == behind) return;
          list.AddLine({corner.x + static_cast<float>(a.x), corner.y + static_cast<float>(a.y)},
                       {corner.x + static_cast<float>(b.x), corner.y + static_cast<float>(b.y)},
                       gizmo::color_of(part, on, front ? (part == GizmoPart::kFree && !on ? 0.6f : 1.0f) : 0.22f),
                       ui::px(on ? 3.5f : 2.0f));
        });
      }
    const auto size = gizmo::unit(picture, grip);
    if (!size) return;
    for (int i = 0; i < 3; ++i) {
      // Each letter where its ring is nearest to the eye, between the other two axes.
      const dvec3 u = grip.axes[(i + 1) % 3], v = grip.axes[(i + 2) % 3], back = -picture.forward();
      const dvec3 place =
          grip.pivot + static_cast<double>(gizmo::kRing) * *size *
                           glm::normalize((dot(u, back) < 0 ? -1.0 : 1.0) * u + (dot(v, back) < 0 ? -1.0 : 1.0) * v);
      const auto at = picture.pixel(place), middle = picture.pixel(grip.pivot);
      if (!at || !middle) continue;
      dvec2 way = dvec2(*at) - dvec2(*middle);
      way = length(way) > 1.0 ? glm::normalize(way) : dvec2(0, -1);
      const auto part = static_cast<GizmoPart>(static_cast<int>(GizmoPart::kX) + i);
      gizmo::letter(list,
                    {corner.x + static_cast<float>(at->x + 11.0 * way.x * double(ui::scale())),
                     corner.y + static_cast<float>(at->y + 11.0 * way.y * double(ui::scale()))},
                    i, gizmo::color_of(part, bright == part));
    }
    if (const auto middle = picture.pixel(grip.pivot))
      list.AddCircleFilled({corner.x + static_cast<float>(middle->x), corner.y + static_cast<float>(middle->y)},
                           ui::px(3), gizmo::color_of(GizmoPart::kFree, false), 16);
  }
  double& snap_step() override { return settings_.snap_turn; }
  const char* snap_unit() const override { return "\u00b0"; }

 private:
  static dvec3 axis(const GizmoPicture& picture, const GizmoGrip& grip, GizmoPart part) {
    if (is_axis(part)) return grip.axes[axis_of(part)];
    return picture.orthographic > 0.0 ? -picture.forward() : glm::normalize(picture.view.eye - grip.pivot);
  }
  // Segments of a ring in pixels, and whether each faces the eye.
  template <class Visit>
  static void each_piece(const GizmoPicture& picture, const GizmoGrip& grip, GizmoPart part, Visit visit) {
    const auto size = gizmo::unit(picture, grip);
    if (!size) return;
    const dvec3 n = axis(picture, grip, part);
    const dvec3 sight = picture.orthographic > 0.0 ? picture.forward() : glm::normalize(grip.pivot - picture.view.eye);
    const dvec3 u = glm::normalize(cross(n, std::abs(n.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0))), v = cross(n, u);
    const double radius = static_cast<double>(gizmo::kRing * (part == GizmoPart::kFree ? kOuter : 1.0f)) * *size;
    const bool facing = std::abs(dot(n, sight)) > 0.97;
    std::optional<dvec3> before;
    for (int k = 0; k <= kPieces; ++k) {
      const double angle = 2.0 * glm::pi<double>() * k / kPieces;
      const dvec3 out = std::cos(angle) * u + std::sin(angle) * v;
      const auto now = picture.pixel(grip.pivot + radius * out);
      if (now && before) visit(*before, *now, facing || dot(out, sight) < 0.05);
      before = now;
    }
  }

  double turned_ = 0.0;  // [rad] so far, without snapping
  dvec3 axis_{0};        // [1] world, of the current rotation; 0: not known yet
};

}  // namespace

std::unique_ptr<ViewTool> make_turn_tool(Settings& settings) {
  return std::make_unique<TurnTool>(settings);
}

}  // namespace pliant
