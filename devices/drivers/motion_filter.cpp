#include "devices/drivers/motion_filter.h"

#include <algorithm>
#include <cmath>

#include "devices/drivers/stick_control.h"

namespace pliant {
namespace {

constexpr double kGravity = 9.80665;        // [m/s2]
constexpr double kPull = 0.5;               // [1/s] rate at which gravity corrects the gyroscope
constexpr double kGravityWithin = 0.15;     // [1] of g: beyond, the acceleration is not used as gravity
constexpr double kStillTurn = 0.03;         // [rad/s] less is rest, after bias correction
constexpr double kStillFelt = 0.3;          // [m/s2] the same for the change of the measured acceleration
constexpr double kStillFor = 0.5;           // [s] of rest before the bias is learned
constexpr double kLearn = 0.5;              // [1/s] learning rate
constexpr double kMostBias = 0.1;           // [rad/s]
constexpr double kLongestFilterStep = 0.1;  // [s]

}  // namespace

void MotionFilter::step(const dvec3& turning, const dvec3& felt, double dt) {
  const double weight = length(felt);
  if (!std::isfinite(weight) || !std::isfinite(length(turning))) return;
  dt = std::clamp(dt, 0.0, kLongestFilterStep);
  const bool gravity = std::abs(weight / kGravity - 1.0) < kGravityWithin;
  const dvec3 up(0, 1, 0);
  if (!placed_ && gravity) {  // the shortest rotation that makes the measured gravity vertical
    const dvec3 now = felt / weight, axis = cross(now, up);
    const double sine = length(axis), angle = std::atan2(sine, dot(now, up));
    rotation_ = sine > 1e-9        ? rotation_by(axis * (angle / sine))
                : dot(now, up) > 0 ? dquat(1, 0, 0, 0)
                                   : dquat(0, 0, 0, 1);
    last_felt_ = felt;
    placed_ = true;
    return;
  }
  const dvec3 turn = turning - bias_;
  const bool still = length(turn) < kStillTurn && length(felt - last_felt_) < kStillFelt && gravity;
  last_felt_ = felt;
  still_ = still ? still_ + dt : 0.0;
  if (still_ > kStillFor)
    bias_ = glm::clamp(bias_ + std::min(kLearn * dt, 1.0) * turn, dvec3(-kMostBias), dvec3(kMostBias));
  rotation_ = glm::normalize(rotation_ * rotation_by(turn * dt));
  if (gravity) {
    const dvec3 seen = rotation_ * (felt / weight);
    rotation_ = glm::normalize(rotation_by(std::min(kPull * dt, 1.0) * cross(seen, up)) * rotation_);
  }
}

}  // namespace pliant
