#include "devices/wrappers/delay.h"

#include <algorithm>
#include <cmath>

namespace pliant {

double Delay::in_samples(double delay) const {
  return std::round(std::min(parameters_.samples ? delay : delay * rate(), kMost * rate()));
}

DeviceCapabilities Delay::capabilities() const {
  DeviceCapabilities can = Wrapper::capabilities();
  can.latency += (in_samples(parameters_.sensed) + in_samples(parameters_.written)) / rate();
  return can;
}

Status Delay::begin() {
  sensed_.assign(static_cast<std::size_t>(in_samples(parameters_.sensed)) + 1, {});
  written_.assign(static_cast<std::size_t>(in_samples(parameters_.written)) + 1, {});
  sensed_at_ = written_at_ = 0;
  return Done{};
}

// A read without a sample is delayed too, so that gaps keep their position.
bool Delay::read(DeviceSample& sample) {
  Kept& newest = sensed_[sensed_at_];
  newest.there = inner().read(newest.sample);
  sensed_at_ = (sensed_at_ + 1) % sensed_.size();
  const Kept& oldest = sensed_[sensed_at_];
  if (oldest.there) sample = oldest.sample;
  return oldest.there;
}

void Delay::write(const DeviceWrench& wrench) {
  written_[written_at_] = wrench;
  written_at_ = (written_at_ + 1) % written_.size();
  inner().write(written_[written_at_]);
}

void Delay::make_safe() noexcept {
  std::fill(written_.begin(), written_.end(), DeviceWrench{});
  Wrapper::make_safe();
}

void Delay::close() {
  inner().write({});
  Wrapper::close();
}

}  // namespace pliant
