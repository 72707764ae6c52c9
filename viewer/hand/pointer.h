// The mouse as a 3-DoF probe: the picture gives two, pressing a button and the wheel the third.
#pragma once

#include <optional>
#include <vector>

#include "components/world.h"
#include "viewer/hand/camera_control.h"

namespace pliant {

// Pseudo-haptics: while the probe presses, the drawn cursor moves more slowly than the pointer, by a gain that falls
// with the force. This shows a resistance that a mouse cannot render. After release it returns to the pointer.
class HeavyCursor {
 public:
  static constexpr double kHalfForce = 1.0;  // [N] at which the gain is one half

  static double gain(double force) {
    return 1.0 / (1.0 + force / kHalfForce);
  }                                  // [1] drawn over true motion; force [N]
  void move_to(double x, double y);  // [pixel] pointer position
  // `pressing`: the probe is in contact, with `force` [N].
  void update(bool pressing, double force, double dt);
  double x() const { return x_; }  // [pixel] of the drawn cursor and the probe
  double y() const { return y_; }

 private:
  bool placed_ = false;
  double hand_x_ = 0, hand_y_ = 0, moved_x_ = 0, moved_y_ = 0, x_ = 0, y_ = 0;
};

// Points are picked on the deformed surface as drawn (Renderer::pick). Depth counts from the rest position of the
// picked point: counted from the dent itself, every press would move away from its own dent. A soft or rigid body has
// no such rest position: while it is pressed, it is picked in its shape at the start of the press (holds()).
//
// A body can also be dragged: a point of its surface (ProbeHold) follows the mouse in the plane that faces the eye, on
// a spring.
class Pointer {
 public:
  // Stores the touchable objects, so that pointing needs nothing that the touch clock writes. `radius` [m] of the
  // probe, `meets`: what it touches; `view`: the initial camera.
  Pointer(const World& world, double radius, const Viewpoint& view, ProbeMeets meets = ProbeMeets::kAll);

  // The picked point of a ray; empty: background.
  void see(const std::optional<Picked>& seen, const ViewRay& ray);
  bool over_touchable() const { return hit_ && hit_->reach > 0; }         // from outside: can be pressed
  bool over_body() const { return hit_ && !(hit_->pulls == kNoEntity); }  // can be dragged

  void hold(bool held);
  // The pressed body, for PickQuestion::holds; kNoEntity: none.
  Entity holds() const { return pressed_; }
  // Drags the body under the pointer until hold(false).
  void grab();
  bool pulls() const { return grip_.has_value(); }
  void follow(const ViewRay& ray, const Viewpoint& view);  // while dragging
  void push(double clicks, const Viewpoint& view);         // while dragging; > 0: away from the eye
  ProbeHold probe_hold() const;
  void deepen(int steps);  // while pressed: depth of this press and the next ones
  void stand(int steps);   // while not pressed: the depth that is kept
  bool pressing() const { return held_ || standing_ > 0; }
  double depth_goal() const;                                                 // [m]
  bool free() const { return !grip_ && (!hit_ || height_ > 0.2 * hover_); }  // away from every surface

  // The probe's current target [m] world. `dt` [s] since the last call.
  dvec3 update(double dt);

 private:
  struct Target {
    Entity object;
    double reach;  // [m]
    bool is_body = false;
    Entity pulls = kNoEntity;  // the body that is dragged by this surface
  };
  struct Hit {
    dvec3 point{0}, normal{0};  // [m], [1] world, at rest
    double reach = 0;           // [m] 0: not deformable
    Entity object = kNoEntity, pulls = kNoEntity;
    bool is_body = false;
    dvec3 drawn{0};  // [m] world, as drawn
  };
  void add_bodies(const World& world);
  void note_pressed();

  std::vector<Target> targets_;
  double radius_, size_ = 1.0, hover_;  // [m]
  double reach_;                        // [m] of the last picked object
  std::optional<Hit> hit_;
  Entity pressed_ = kNoEntity;  // the body being pressed
  std::optional<dvec3> grip_;   // [m] world, target of the dragged point
  ProbeHold hold_;              // of the drag
  dvec3 aside_;                 // [m] the probe's position while nothing is picked
  double away_;                 // [m] distance of the last hit from the eye
  bool held_ = false;
  int deep_, standing_ = 0;  // [1] steps
  double height_;            // [m] of the probe's lowest point above the rest surface; < 0: pressed in
};

}  // namespace pliant
