// Delays each sample by a random time, and keeps the order of sensing.
#pragma once

#include <vector>

#include "devices/wrappers/wrapper.h"

namespace pliant {

class Jitter : public Wrapper {
 public:
  // `most` [s]: delays are uniform from 0 to it, in whole samples.
  Jitter(std::unique_ptr<Driver> inner, double most, std::uint64_t seed)
      : Wrapper(std::move(inner)), most_(most), seed_(seed), random_(seed) {}
  DeviceCapabilities capabilities() const override;
  bool read(DeviceSample& sample) override;

  static constexpr double kMost = 10.0;  // [s]

 protected:
  Status begin() override;

 private:
  struct Late {
    DeviceSample sample;
    std::uint64_t due = 0;  // the read that delivers it
  };
  double most_;  // [s]
  std::uint64_t seed_, reads_ = 0, samples_ = 0;
  Random random_;
  std::vector<Late> line_;  // a ring
  std::size_t first_ = 0, waiting_ = 0;
};

}  // namespace pliant
