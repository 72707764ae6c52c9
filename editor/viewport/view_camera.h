// The viewport's camera: it orbits a target and moves smoothly to its goal.
#pragma once

#include <optional>

#include "components/mesh.h"
#include "systems/visual/renderer.h"
#include "window/camera_control.h"

namespace pliant {

class ViewCamera {
 public:
  ViewCamera() { home({}); }
  void home(const Box& scene);  // shows the whole scene from the front, slightly above, at once
  void frame(const Box& box);   // moves there, with the current direction
  // `dx`, `dy` [pixel] of a picture `height` pixels high.
  void orbit(double dx, double dy, int height) { control_->orbit(dx, dy, height); }
  void pan(double dx, double dy, int height) { control_->pan(dx, dy, height); }
  void zoom(double steps) { control_->zoom(steps); }
  void look_from(double azimuth, double elevation) { control_->look_from(azimuth, elevation); }  // [rad]
  void update(double dt) { control_->update(dt); }
  bool moving() const;

  Viewpoint viewpoint() const { return control_->viewpoint(); }
  // [m] height of the orthographic view; at the target it equals the perspective one's.
  double orthographic_height() const;

 private:
  std::optional<CameraControl> control_;
};

// Position of a point in a picture: pixels from the upper left corner, and depth along the view [m]; empty: behind it.
std::optional<dvec3> on_picture(const Viewpoint& view, double orthographic, int width, int height, dvec3 place);
// The ray through a pixel.
ViewRay view_ray(const Viewpoint& view, double orthographic, double x, double y, int width, int height);

}  // namespace pliant
