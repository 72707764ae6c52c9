// The mouse as a probe with three degrees of freedom: the picture gives two, holding a button and the wheel the third.
#pragma once

#include <optional>
#include <vector>

#include "components/world.h"
#include "window/camera_control.h"

namespace pliant {

// Pseudo-haptics: while the probe presses, the cursor that is drawn goes slower than the hand, by a gain that falls
// with the force, so that eyes feel a resistance that a mouse cannot give. Let go, it rejoins the hand.
class HeavyCursor {
 public:
  static constexpr double kHalfForce = 1.0;  // [N] at which the cursor goes half as far as the hand

  static double gain(double force) {
    return 1.0 / (1.0 + force / kHalfForce);
  }                                  // [1] drawn over true motion; force [N]
  void move_to(double x, double y);  // [pixel] where the hand is
  // `pressing`: the probe is pushed into something that answers with `force` [N].
  void update(bool pressing, double force, double dt);
  double x() const { return x_; }  // [pixel] where it is drawn, and where the probe is
  double y() const { return y_; }

 private:
  bool placed_ = false;
  double hand_x_ = 0, hand_y_ = 0, moved_x_ = 0, moved_y_ = 0, x_ = 0, y_ = 0;
};

// What is pointed at is what the picture shows there, dents and all (Renderer::pick). How deep the probe goes counts
// from where that very place is at rest: counted from the dent itself, every press would run away from its own dent. A
// soft or rigid body has no such place: while it is pressed, it is asked of as it stood when the press began (holds()).
//
// A body can also be pulled: taken hold of at a place of its surface (ProbeHold), it follows the mouse in the plane
// that faces the eye, on a spring.
class Pointer {
 public:
  // Remembers what gives way, so that pointing needs nothing that the touch clock writes. `radius` [m] of the probe,
  // `meets` what there is for it; `view` is where it is looked at from at first.
  Pointer(const World& world, double radius, const Viewpoint& view, ProbeMeets meets = ProbeMeets::kAll);

  // What the picture shows along a ray; nothing: the surroundings.
  void see(const std::optional<Picked>& seen, const ViewRay& ray);
  bool over_touchable() const { return hit_ && hit_->reach > 0; }         // from outside: what can be pressed
  bool over_body() const { return hit_ && !(hit_->pulls == kNoEntity); }  // what can be pulled

  void hold(bool held);
  // The body that is pressed, for PickQuestion::holds; kNoEntity: none.
  Entity holds() const { return pressed_; }
  // Takes hold of the body that is pointed at, until hold(false).
  void grab();
  bool pulls() const { return grip_.has_value(); }
  void follow(const ViewRay& ray, const Viewpoint& view);  // while it pulls
  void push(double clicks, const Viewpoint& view);         // while it pulls; > 0: away from the eye
  ProbeHold probe_hold() const;
  void deepen(int steps);  // while held: how deep this press and the next go
  void stand(int steps);   // without holding: the depth at which it stays
  bool pressing() const { return held_ || standing_ > 0; }
  double depth_goal() const;                                                 // [m]
  bool free() const { return !grip_ && (!hit_ || height_ > 0.2 * hover_); }  // clear of every surface

  // Where the probe should be now [m] world. `dt` [s] since the last call.
  dvec3 update(double dt);

 private:
  struct Target {
    Entity object;
    double reach;  // [m]
    bool is_body = false;
    Entity pulls = kNoEntity;  // the body that moves when this is pulled
  };
  struct Hit {
    dvec3 point{0}, normal{0};  // [m], [1] world, at rest
    double reach = 0;           // [m] 0: it does not give way
    Entity object = kNoEntity, pulls = kNoEntity;
    bool is_body = false;
    dvec3 drawn{0};  // [m] world, as the picture shows it
  };
  void add_bodies(const World& world);
  void note_pressed();

  std::vector<Target> targets_;
  double radius_, size_ = 1.0, hover_;  // [m]
  double reach_;                        // [m] of what was last pointed at
  std::optional<Hit> hit_;
  Entity pressed_ = kNoEntity;  // the body whose press is under way
  std::optional<dvec3> grip_;   // [m] world, where the mouse has what it pulls
  ProbeHold hold_;              // of the pull
  dvec3 aside_;                 // [m] where the probe is while nothing is pointed at
  double away_;                 // [m] from the eye, where something was hit last
  bool held_ = false;
  int deep_, standing_ = 0;  // [1] steps
  double height_;            // [m] of the probe's lowest point above the surface at rest; < 0: pressed in
};

}  // namespace pliant
