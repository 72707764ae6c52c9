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
// from where that very place is at rest: counted from the dent itself, every press would run away from its own dent.
class Pointer {
 public:
  // Remembers what gives way, so that pointing needs nothing that the touch clock writes. `radius` [m] of the probe;
  // `view` is where it is looked at from at first.
  Pointer(const World& world, double radius, const Viewpoint& view);

  // What the picture shows along a ray; nothing: the surroundings.
  void see(const std::optional<Picked>& seen, const ViewRay& ray);
  bool over_touchable() const { return hit_ && hit_->reach > 0; }  // of the deformables, from outside

  void hold(bool held) { held_ = held; }
  void deepen(int steps);  // while held: how deep this press and the next go
  void stand(int steps);   // without holding: the depth at which it stays
  bool pressing() const { return held_ || standing_ > 0; }
  double depth_goal() const;                                     // [m]
  bool free() const { return !hit_ || height_ > 0.2 * hover_; }  // clear of every surface

  // Where the probe should be now [m] world. `dt` [s] since the last call.
  dvec3 update(double dt);

 private:
  struct Target {
    Entity object;
    double reach;  // [m]
  };
  struct Hit {
    dvec3 point{0}, normal{0};  // [m], [1] world, at rest
    double reach = 0;           // [m] 0: it does not give way
  };

  std::vector<Target> targets_;
  double radius_, size_ = 1.0, hover_;  // [m]
  double reach_;                        // [m] of what was last pointed at
  std::optional<Hit> hit_;
  dvec3 aside_;  // [m] where the probe is while nothing is pointed at
  double away_;  // [m] from the eye, where something was hit last
  bool held_ = false;
  int deep_, standing_ = 0;  // [1] steps
  double height_;            // [m] of the probe's lowest point above the surface at rest; < 0: pressed in
};

}  // namespace pliant
