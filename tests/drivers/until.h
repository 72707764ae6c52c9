// Waits for other threads, with a time-out so long that only a fault can exceed it.
#pragma once

#include <chrono>
#include <thread>

#include "pliant/driver.h"

namespace pliant {

template <class F>
bool soon(F&& enough) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!enough()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

// Reads and writes as a session does, until `enough(came)`.
template <class F>
bool runs_until(Driver& driver, DeviceSample& sample, const DeviceWrench& wrench, F&& enough) {
  return soon([&] {
    const bool came = driver.read(sample);
    driver.write(wrench);
    return enough(came);
  });
}

}  // namespace pliant
