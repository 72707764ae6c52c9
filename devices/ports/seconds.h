// The clock of drivers; tests use their own.
#pragma once

#include <functional>

#include "runtime/clock.h"

namespace pliant {

using SecondsClock = std::function<double()>;  // [s] monotonic
inline double monotonic_seconds() {
  return static_cast<double>(now_ns()) * 1e-9;
}

}  // namespace pliant
