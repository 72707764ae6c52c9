// Maps a device's workspace to the world: rotated axes, a clutch, and rate control at the border of the workspace.
#pragma once

#include "devices/wrappers/wrapper.h"

namespace pliant {

struct WorkspaceParameters {
  dquat frame{1, 0, 0, 0};  // device axes to world axes
  int clutch = -1;          // button: while pressed the pose is frozen, and the hand is repositioned; -1: none
  double border = 0.0;      // [m] from the device's origin: beyond it, rate control; 0: none
  double rate = 4.0;        // [1/s] of the depth beyond the border, at the device
};

// World pose = frame * device's + an offset that clutch and border change continuously.
//
// While the clutch is pressed the sample is not ready, so no force is rendered: the hand moves and the probe does not.
// Beyond the border the offset drifts outward at rate times the depth: continuous at the border, and zero there. The
// drift moves the probe without the hand, and its work is not the hand's. Therefore the drift stops while force is
// written against it (kRateForce).
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
  dvec3 kept_{0};               // [m] world: the pose kept by the clutch
  dquat kept_rotation_{1, 0, 0, 0};
  bool clutched_ = false;
  double period_ = 1e-3, last_ = 0.0;  // [s] sample period; time of the last sample, 0: unspecified
};

}  // namespace pliant
