// Drops samples, forces, or both at random.
#pragma once

#include "devices/wrappers/wrapper.h"

namespace pliant {

// After a dropped force the device keeps the previous one. The zero force of close and make_safe is never dropped.
class Drop : public Wrapper {
 public:
  // Probabilities [1] of a drop.
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
