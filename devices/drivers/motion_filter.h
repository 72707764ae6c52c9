// Rotation from a gyroscope and an accelerometer by a complementary filter (Mahony et al. 2008, without its integral
// term): integrates the gyroscope, and corrects the tilt by gravity. Rotation about the vertical drifts, because no
// sensor observes it. The gyroscope's bias is learned at rest.
#pragma once

#include "pliant/math.h"

namespace pliant {

class MotionFilter {
 public:
  // `turning`: angular velocity [rad/s], and `felt`: specific force [m/s2], in the device's axes (right, up, towards
  // the user). An accelerometer at rest reads +g upwards. `dt` [s].
  void step(const dvec3& turning, const dvec3& felt, double dt);

  const dquat& rotation() const { return rotation_; }  // device to world, unit
  const dvec3& bias() const { return bias_; }          // [rad/s]

 private:
  dquat rotation_{1, 0, 0, 0};
  dvec3 bias_{0}, last_felt_{0};
  double still_ = 0.0;  // [s] duration of rest so far
  bool placed_ = false;
};

}  // namespace pliant
