// A parameter that a level offers to its user (key `expose` of PLIANT_simulation).
#pragma once

#include <string>

namespace pliant {

struct Slider {
  std::string object, key;                   // of Session::set
  std::string name, unit;                    // label; "": no unit
  double low = 0.0, high = 0.0, step = 0.0;  // in that unit; step 0: continuous
};

}  // namespace pliant
