// A camera controlled by the mouse: it orbits a target and moves smoothly to its goal.
#pragma once

#include "components/mesh.h"
#include "systems/visual/renderer.h"

namespace pliant {

// From the eye through a pixel.
struct ViewRay {
  dvec3 from{0};          // [m] world
  dvec3 along{0, 0, -1};  // [1] unit
};
// Pixels count from the upper left corner.
ViewRay ray_through(const Viewpoint& view, double x, double y, int width, int height);

class CameraControl {
 public:
  // Starts at `home`; `scene` [m] world is what frame() shows. The horizon stays level, so a rolled `home` is
  // straightened.
  CameraControl(const Viewpoint& home, const Box& scene);
  // Starts in front of the scene, slightly above, and shows all of it.
  static CameraControl before(const Box& scene);

  // `dx`, `dy` [pixel] of a picture `height` pixels high.
  void orbit(double dx, double dy, int height);
  void pan(double dx, double dy, int height);
  void zoom(double steps);                           // of a wheel, > 0: nearer
  void look_from(double azimuth, double elevation);  // [rad]
  void frame();                                      // shows the whole scene, from the current direction
  void frame(const Box& box);                        // shows this box, and uses it from now on; nothing if empty
  void home();
  bool moving() const;     // the view has not reached its goal
  void update(double dt);  // [s] since the last call

  Viewpoint viewpoint() const;

 private:
  struct Pose {
    dvec3 target{0};       // [m]
    double distance = 1;   // [m]
    double azimuth = 0;    // [rad] about +Y, 0: from +Z
    double elevation = 0;  // [rad]
  };
  static Viewpoint at(const Pose& pose, float yfov);

  Box scene_;
  float yfov_;   // [rad]
  double size_;  // [m] of the scene
  Pose home_, goal_, shown_;
};

}  // namespace pliant
