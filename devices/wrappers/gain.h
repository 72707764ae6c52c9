// Positions and forces times a number: motion and force are scaled about the device's origin.
#pragma once

#include "devices/wrappers/wrapper.h"

namespace pliant {

// World position = motion * the device's; the device's force = force * the world's. Power is kept where both are the
// same: then the device takes from the hand what the world takes from the probe. Else the world that is felt is
// force/motion times as strong, and a passive world may be felt as an active one where that is above 1 and more than
// the hand stores. Turning is not scaled, torque is by `force`, times 1/motion per newton metre of lever left to the
// world.
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
