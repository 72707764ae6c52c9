#include "devices/wrappers/jitter.h"

#include <algorithm>
#include <cmath>

namespace pliant {

DeviceCapabilities Jitter::capabilities() const {
  DeviceCapabilities can = Wrapper::capabilities();
  can.latency += most_;  // the worst case
  return can;
}

Status Jitter::begin() {
  samples_ = static_cast<std::uint64_t>(std::round(std::min(most_, kMost) * rate()));
  line_.assign(samples_ + 2, {});
  first_ = waiting_ = 0;
  reads_ = 0;
  random_ = Random(seed_);
  return Done{};
}

// Of several due samples the newest is delivered.
bool Jitter::read(DeviceSample& sample) {
  DeviceSample now;
  if (inner().read(now)) {
    const auto late = static_cast<std::uint64_t>(random_.uniform() * static_cast<double>(samples_ + 1));
    std::uint64_t due = reads_ + late;
    if (waiting_ > 0) due = std::max(due, line_[(first_ + waiting_ - 1) % line_.size()].due);
    line_[(first_ + waiting_++) % line_.size()] = {now, due};
  }
  bool any = false;
  for (; waiting_ > 0 && line_[first_].due <= reads_; --waiting_) {
    sample = line_[first_].sample;
    first_ = (first_ + 1) % line_.size();
    any = true;
  }
  ++reads_;
  return any;
}

}  // namespace pliant
