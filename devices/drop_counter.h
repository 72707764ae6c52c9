// Access to a driver's counts of dropped frames (CountsDropped), also behind wrappers. On the thread that reads.
#pragma once

#include "pliant/device_state.h"

namespace pliant {

inline DroppedFrames dropped_frames(const Driver& driver) {
  const auto* const counts = dynamic_cast<const CountsDropped*>(&driver);
  return counts ? counts->dropped() : DroppedFrames{};
}

}  // namespace pliant
