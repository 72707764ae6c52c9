// Replaces the device's poses by those of a file (devices/pose_file.h), with their timing. The inner device is still
// read, so that it stays connected, and zero is written to it.
#pragma once

#include <vector>

#include "devices/pose_file.h"
#include "devices/wrappers/wrapper.h"

namespace pliant {

// Row n is returned with the inner device's first sample at or after its time; the last row is kept.
class Replay : public Wrapper {
 public:
  Replay(std::unique_ptr<Driver> inner, std::vector<PoseFileRow> rows)
      : Wrapper(std::move(inner)), rows_(std::move(rows)) {}
  bool read(DeviceSample& sample) override {
    DeviceSample now;
    if (!inner().read(now)) return false;
    if (samples_ == 0) first_ = now.time;
    const double time = (now.time > 0.0 ? now.time - first_ : static_cast<double>(samples_) / rate()) + 1e-9;
    ++samples_;
    while (row_ + 1 < rows_.size() && rows_[row_ + 1].sample.time - rows_.front().sample.time <= time) ++row_;
    sample = rows_[row_].sample;
    sample.time = now.time;
    return true;
  }
  void write(const DeviceWrench&) override { inner().write({}); }

 protected:
  Status begin() override {
    row_ = 0;
    samples_ = 0;
    return Done{};
  }

 private:
  std::vector<PoseFileRow> rows_;
  std::size_t row_ = 0;
  std::uint64_t samples_ = 0;
  double first_ = 0.0;  // [s]
};

}  // namespace pliant
