// Mapping of a device's workspace to the world: the device's axes turned into the world's, a clutch, and rate control
// where the workspace ends.
#pragma once

#include "devices/wrappers/wrapper.h"

namespace pliant {

struct WorkspaceParameters {
  dquat frame{1, 0, 0, 0};  // device's axes to world's
  int clutch = -1;          // button: while it is down the pose stands still, and the hand is moved back; -1: none
  double border = 0.0;      // [m] from the device's origin: beyond, it is pushed on at a rate; 0: none
  double rate = 4.0;        // [1/s] of the depth beyond the border, at the device
};

// World pose = frame * device's + an offset that clutch and border change, never with a jump.
//
// While the clutch is down the sample says not ready: no force leaves, since the hand moves and the probe does not.
// Beyond the border the offset drifts outward with rate times the depth: continuous at the border, and zero there. The
// drift moves the probe without the hand; what the world gives for that way is not the hand's work, so that the drift
// stands still while force is written against it (kRateForce).
class Workspace : public Wrapper {
 public:
  static constexpr double kRateForce = 0.05;  // [N]

  Workspace(std::unique_ptr<Driver> inner, WorkspaceParameters parameters)
      : Wrapper(std::move(inner)), parameters_(parameters), back_(glm::conjugate(parameters.frame)) {}
  DeviceCapabilities capabilities() const override;
  bool read(DeviceSample& sample) override;
  void write(const DeviceWrench& wrench) override;
  dvec3 offset() const { return offset_; }  // [m] world

 protected:
  Status begin() override;

 private:
  WorkspaceParameters parameters_;
  dquat back_;
  dvec3 offset_{0}, force_{0};  // [m], [N] world
  dvec3 kept_{0};               // [m] world: the pose that the clutch holds
  dquat kept_rotation_{1, 0, 0, 0};
  bool clutched_ = false;
  double period_ = 1e-3, last_ = 0.0;  // [s] of the device; when the last sample was sensed, 0: not said
};

}  // namespace pliant
