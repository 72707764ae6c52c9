// Quantises poses and forces.
#pragma once

#include "devices/wrappers/wrapper.h"

namespace pliant {

class Quantise : public Wrapper {
 public:
  // Resolution of position [m] and of force [N]; 0: unchanged. Rounded to the nearest.
  Quantise(std::unique_ptr<Driver> inner, double position, double force)
      : Wrapper(std::move(inner)), position_(position), force_(force) {}
  bool read(DeviceSample& sample) override {
    if (!inner().read(sample)) return false;
    sample.position = counts(sample.position, position_);
    return true;
  }
  void write(const DeviceWrench& wrench) override {
    DeviceWrench counted = wrench;
    counted.force = counts(wrench.force, force_);
    inner().write(counted);
  }

 private:
  static dvec3 counts(dvec3 v, double count) { return count > 0.0 ? glm::round(v / count) * count : v; }
  double position_, force_;
};

}  // namespace pliant
