// The arithmetic of gizmos: from mouse positions to metres, angles and factors, and from these to transforms of the
// dragged nodes. Needs no window.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "editor/document/edits.h"
#include "editor/viewport/view_camera.h"

namespace pliant {

// The picture with the gizmo.
struct GizmoPicture {
  Viewpoint view;
  double orthographic = 0.0;  // [m] height; 0: perspective
  int width = 1, height = 1;  // [pixel]
  ViewRay ray(double x, double y) const { return view_ray(view, orthographic, x, y, width, height); }
  std::optional<dvec3> pixel(dvec3 place) const { return on_picture(view, orthographic, width, height, place); }
  dvec3 forward() const { return glm::normalize(view.target - view.eye); }
};

enum class GizmoPart : std::uint8_t { kNone, kX, kY, kZ, kYZ, kZX, kXY, kFree };
inline bool is_axis(GizmoPart part) {
  return part >= GizmoPart::kX && part <= GizmoPart::kZ;
}
inline bool is_plane(GizmoPart part) {
  return part >= GizmoPart::kYZ && part <= GizmoPart::kXY;
}
// For an axis, its number; for a plane, the number of its normal axis.
inline int axis_of(GizmoPart part) {
  return is_plane(part) ? static_cast<int>(part) - static_cast<int>(GizmoPart::kYZ)
                        : static_cast<int>(part) - static_cast<int>(GizmoPart::kX);
}

// The dragged nodes (the topmost of a selection), and their pivot.
struct GizmoGrip {
  struct Held {
    NodeId id;
    LocalTransform local;
    dmat4 parent{1};  // parent -> world
    dvec3 place{0};   // [m] world
  };
  std::vector<Held> held;
  dvec3 pivot{0};  // [m] world
  dmat3 axes{1};   // world, unit columns; not always orthogonal: a node's own axes under an uneven scale
  bool local = false;
};
enum class Pivot : std::uint8_t {
  kOrigin,  // the mean of the nodes' origins
  kMiddle,  // the centre of their bounds
};
// `local`: axes of `active`, else the world's. If there is nothing to drag, `held` is empty.
GizmoGrip grip_of(const State& state, std::span<const NodeId> ids, NodeId active, Pivot pivot, bool local);

// [m] of a pixel at a point; empty: behind the eye.
std::optional<double> metres_of_pixel(const GizmoPicture& picture, dvec3 place);
// [m] along the line through `origin`, at the point nearest to a ray; empty: parallel, or behind.
std::optional<double> along_line(const ViewRay& ray, dvec3 origin, dvec3 along);
// [m] intersection of a ray and a plane; empty: edge-on, or behind.
std::optional<dvec3> on_plane(const ViewRay& ray, dvec3 origin, dvec3 normal);

// Displacement between two pixels, along the grip's axes [m].
std::optional<dvec3> moved_by(const GizmoPicture& picture, const GizmoGrip& grip, GizmoPart part, dvec2 from, dvec2 to);
// Rotation about `axis` between two pixels [rad]; add small ones for a large rotation.
double turned_by(const GizmoPicture& picture, dvec3 pivot, dvec3 axis, dvec2 from, dvec2 to, double radius_pixels);
// Factors along the grip's axes between two pixels.
std::optional<dvec3> scaled_by(const GizmoPicture& picture, const GizmoGrip& grip, GizmoPart part, dvec2 from,
                               dvec2 to);

// The resulting transforms.
std::vector<Placing> moved(const GizmoGrip& grip, dvec3 by);                   // `by` [m] world
std::vector<Placing> turned(const GizmoGrip& grip, dvec3 axis, double angle);  // `axis` world
std::vector<Placing> scaled(const GizmoGrip& grip, dvec3 factors);             // along the grip's axes

double snapped(double value, double step);  // to a multiple; step 0: as it is

// Text typed during a drag: an axis' letter, then a quantity (viewer/ui/quantity.h): "x 0.05", "-3mm".
struct TypedValue {
  GizmoPart axis = GizmoPart::kNone;  // none: unchanged
  std::optional<double> value;        // in `unit`; empty: no number yet
  bool understood = true;
};
TypedValue typed_value(const std::string& text, const std::string& unit);

// "12 mm", with a suitable unit.
std::string metres_text(double metres, int digits = 4);

}  // namespace pliant
