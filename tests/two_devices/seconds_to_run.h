// How long a test in real time runs: PLIANT_DEVICE_SECONDS, else 3. [s]
#pragma once

#include <cstdlib>

namespace pliant {

inline double seconds_to_run() {
  const char* const given = std::getenv("PLIANT_DEVICE_SECONDS");
  return given ? std::atof(given) : 3.0;
}

}  // namespace pliant
