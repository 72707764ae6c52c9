// A driver around a driver. Functions that a wrapper does not override are passed on unchanged: the loop's owner,
// waiting, switching the motors off. When it is closed, zero is written to the inner device.
//
// Memory is allocated from open() on, but not in read and write. Random wrappers use a seed, so that a run can be
// repeated. A wrapper does not support write_model, because it would have to transform the model like samples.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "devices/drop_counter.h"
#include "pliant/driver.h"

namespace pliant {

class Wrapper : public Driver, public CountsDropped {
 public:
  explicit Wrapper(std::unique_ptr<Driver> inner) : inner_(std::move(inner)) {}

  Status open(const std::string& id) override {
    const Status opened = inner_->open(id);
    if (!opened) return opened;
    inside_ = inner_->capabilities();
    return begin();
  }
  DeviceCapabilities capabilities() const override { return inside_ ? *inside_ : inner_->capabilities(); }
  bool read(DeviceSample& sample) override { return inner_->read(sample); }
  void write(const DeviceWrench& wrench) override { inner_->write(wrench); }
  void close() override { inner_->close(); }
  void wait(double seconds) override { inner_->wait(seconds); }
  Status run(std::function<void()> tick) override { return inner_->run(std::move(tick)); }
  void make_safe() noexcept override { inner_->make_safe(); }
  bool safe_line(SafeLine& line) const override { return inner_->safe_line(line); }
  std::string node() const override { return inner_->node(); }
  bool gone() const override { return inner_->gone(); }
  DroppedFrames dropped() const override { return dropped_frames(*inner_); }

 protected:
  // Called when the inner device is open: its capabilities are known.
  virtual Status begin() { return Done{}; }
  Driver& inner() { return *inner_; }
  const Driver& inner() const { return *inner_; }
  // [Hz] of samples: the device's, or the touch clock's default.
  double rate() const {
    const double said = Wrapper::capabilities().rate;
    return said > 0.0 ? said : 1000.0;
  }

 private:
  std::unique_ptr<Driver> inner_;
  std::optional<DeviceCapabilities> inside_;  // cached: in a chain each wrapper would query the next several times
};

// SplitMix64: small, and platform-independent.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double uniform() {  // [0, 1)
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
  }

 private:
  std::uint64_t state_;
};

}  // namespace pliant
