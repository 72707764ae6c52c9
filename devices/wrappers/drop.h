// Samples, forces, or both, are lost by chance.
#pragma once

#include "devices/wrappers/wrapper.h"

namespace pliant {

// A lost force leaves the device with the one before. Zero, on close and in make_safe, is never lost.
class Drop : public Wrapper {
 public:
  // Shares [1] of what is lost.
  Drop(std::unique_ptr<Driver> inner, double sensed, double written, std::uint64_t seed)
      : Wrapper(std::move(inner)), sensed_(sensed), written_(written), seed_(seed), in_(seed), out_(~seed) {}
  bool read(DeviceSample& sample) override {
    DeviceSample now;
    if (!inner().read(now) || in_.uniform() < sensed_) return false;
    sample = now;
    return true;
  }
  void write(const DeviceWrench& wrench) override {
    if (!(out_.uniform() < written_)) inner().write(wrench);
  }
  void close() override {
    inner().write({});
    Wrapper::close();
  }

 protected:
  Status begin() override {
    in_ = Random(seed_);
    out_ = Random(~seed_);
    return Done{};
  }

 private:
  double sensed_, written_;
  std::uint64_t seed_;
  Random in_, out_;
};

}  // namespace pliant
