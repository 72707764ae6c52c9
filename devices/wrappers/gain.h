// Scales positions and forces about the device's origin.
#pragma once

#include "devices/wrappers/wrapper.h"

namespace pliant {

// World position = motion * the device's; the device's force = force * the world's. The hand does force/motion times
// the work on the world: power is preserved if both are equal. A passive world stays passive for any gain, since the
// ratio is constant, but feels motion * force times as stiff. Rotation is not scaled; torque is, by `force`.
class Gain : public Wrapper {
 public:
  Gain(std::unique_ptr<Driver> inner, double motion, double force)
      : Wrapper(std::move(inner)), motion_(motion), force_(force) {}
  bool keeps_power() const { return motion_ == force_; }
  DeviceCapabilities capabilities() const override {
    DeviceCapabilities can = Wrapper::capabilities();
    can.workspace *= motion_;
    can.max_velocity *= motion_;
    can.max_force /= force_;
    can.continuous_force /= force_;
    can.max_torque /= force_;
    can.max_stiffness /= motion_ * force_;
    return can;
  }
  bool read(DeviceSample& sample) override {
    if (!inner().read(sample)) return false;
    sample.position *= motion_;
    return true;
  }
  void write(const DeviceWrench& wrench) override {
    inner().write({force_ * wrench.force, force_ * wrench.torque, force_ * wrench.grip});
  }

 private:
  double motion_, force_;
};

}  // namespace pliant
