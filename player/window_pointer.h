// The mouse as a probe with three degrees of freedom: the picture gives two, holding a button and the wheel the third.
#pragma once

#include <optional>
#include <vector>

#include "components/world.h"
#include "player/camera_control.h"

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

class Pointer {
 public:
  // Remembers every deformable's mesh and place, so that pointing needs nothing that the touch clock writes. `radius`
  // [m] of the probe. The world must outlive it and its deformables stay where they are.
  Pointer(const World& world, double radius);

  bool hits(const Ray& ray) const { return cast(ray).has_value(); }
  void hold(bool held) { held_ = held; }
  void deepen(int steps);  // while held: how deep this press and the next go
  void stand(int steps);   // without holding: the depth at which it stays
  bool pressing() const { return held_ || standing_ > 0; }
  double depth_goal() const;                                      // [m]
  bool free() const { return !over_ || height_ > 0.2 * hover_; }  // clear of every surface

  // Where the probe should be now. `dt` [s] since the last call.
  dvec3 update(const Ray& ray, double dt);
  // A place outside of everything, on the side of the eye.
  dvec3 start(const Viewpoint& view) const;

 private:
  struct Target {
    const Mesh* mesh;
    Pose pose;
    double reach;  // [m]
  };
  struct Hit {
    dvec3 point{0}, normal{0};  // [m], [1] world
    double distance = 0;        // [m] along the ray
    double reach = 0;           // [m]
  };
  std::optional<Hit> cast(const Ray& ray) const;

  std::vector<Target> targets_;
  Box scene_;
  double radius_, size_, hover_;      // [m]
  double reach_ = 0;                  // [m] of what was last pointed at
  bool held_ = false, over_ = false;  // over_: something is pointed at
  int deep_, standing_ = 0;           // [1] steps
  double height_;                     // [m] of the probe's lowest point above the surface at rest; < 0: pressed in
  double away_;                       // [m] from the eye, where nothing is hit
};

}  // namespace pliant
