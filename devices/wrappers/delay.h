// Delays samples, forces, or both by a whole number of samples.
#pragma once

#include <vector>

#include "devices/wrappers/wrapper.h"

namespace pliant {

struct DelayParameters {
  double sensed = 0.0;   // [s] or samples
  double written = 0.0;  // [s] or samples
  bool samples = false;  // both are counts of samples, else seconds, rounded to whole samples at the device's rate
};

// A sample keeps its sensing time. Before the first delayed sample there is none, and no force is rendered.
class Delay : public Wrapper {
 public:
  Delay(std::unique_ptr<Driver> inner, DelayParameters parameters)
      : Wrapper(std::move(inner)), parameters_(parameters) {}
  DeviceCapabilities capabilities() const override;
  bool read(DeviceSample& sample) override;
  void write(const DeviceWrench& wrench) override;
  void make_safe() noexcept override;
  void close() override;

  static constexpr double kMost = 10.0;  // [s]

 protected:
  Status begin() override;

 private:
  struct Kept {
    DeviceSample sample;
    bool there = false;
  };
  double in_samples(double delay) const;
  DelayParameters parameters_;
  std::vector<Kept> sensed_;  // rings: an incoming entry replaces the outgoing one
  std::vector<DeviceWrench> written_;
  std::size_t sensed_at_ = 0, written_at_ = 0;
};

}  // namespace pliant
