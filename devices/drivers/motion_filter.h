// Rotation from a gyroscope and an accelerometer: the gyroscope is integrated, gravity pulls the tilt right (a
// complementary filter: Mahony et al. 2008, without its integral term). What turns about the vertical drifts: nothing
// senses it. At rest the gyroscope's bias is learned.
#pragma once

#include "pliant/math.h"

namespace pliant {

class MotionFilter {
 public:
  // `turning` [rad/s] and `felt` [m/s2] in the device's axes (right, up, towards the user); `felt` is what an
  // accelerometer says: +g upwards at rest. `dt` [s].
  void step(const dvec3& turning, const dvec3& felt, double dt);

  const dquat& rotation() const { return rotation_; }  // device to world, unit
  const dvec3& bias() const { return bias_; }          // [rad/s]

 private:
  dquat rotation_{1, 0, 0, 0};
  dvec3 bias_{0}, last_felt_{0};
  double still_ = 0.0;  // [s] for how long nothing has moved
  bool placed_ = false;
};

}  // namespace pliant
