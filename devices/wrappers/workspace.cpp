#include "devices/wrappers/workspace.h"

#include <algorithm>

namespace pliant {
namespace {

constexpr double kLongestStep = 0.02;  // [s] of drift between two samples

}  // namespace

DeviceCapabilities Workspace::capabilities() const {
  DeviceCapabilities can = Wrapper::capabilities();
  if (parameters_.border > 0.0 || parameters_.clutch >= 0) {
    can.workspace = dvec3(0);  // unlimited
  } else {
    const dmat3 turn = glm::mat3_cast(parameters_.frame);
    dvec3 turned(0);
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) turned[row] += std::abs(turn[column][row]) * can.workspace[column];
    can.workspace = turned;
  }
  return can;
}

Status Workspace::begin() {
  offset_ = force_ = kept_ = dvec3(0);
  kept_rotation_ = dquat(1, 0, 0, 0);
  clutched_ = false;
  last_ = 0.0;
  period_ = 1.0 / rate();
  return Done{};
}

bool Workspace::read(DeviceSample& sample) {
  DeviceSample sensed;
  if (!inner().read(sensed)) return false;
  sample = sensed;
  const dvec3 at = parameters_.frame * sensed.position;
  sample.rotation = parameters_.frame * sensed.rotation * back_;
  const bool clutch = parameters_.clutch >= 0 && (sensed.buttons >> parameters_.clutch & 1u);
  const double dt = sensed.time > 0.0 && last_ > 0.0 ? std::clamp(sensed.time - last_, 0.0, kLongestStep) : period_;
  last_ = sensed.time;
  if (clutch) {
    if (!clutched_) kept_ = at + offset_, kept_rotation_ = sample.rotation;
    offset_ = kept_ - at;
    sample.rotation = kept_rotation_;
    sample.ready = false;
  } else if (const double away = length(sensed.position); parameters_.border > 0.0 && away > parameters_.border) {
    const dvec3 out = at / away;
    if (dot(force_, out) > -kRateForce) offset_ += parameters_.rate * (away - parameters_.border) * dt * out;
  }
  clutched_ = clutch;
  sample.position = at + offset_;
  return true;
}

void Workspace::write(const DeviceWrench& wrench) {
  force_ = wrench.force;
  inner().write({back_ * wrench.force, back_ * wrench.torque, wrench.grip});
}

}  // namespace pliant
