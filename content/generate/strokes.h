// Scripts of probes that approach a solid, press, slide along it at constant depth, lift and retract.
#pragma once

#include <filesystem>
#include <vector>

#include "components/haptic_device.h"
#include "content/author/save_script.h"
#include "content/generate/solid.h"
#include "runtime/result.h"

namespace pliant::generate {

struct Stroke {
  double duration = 8.0;                    // [s] of the whole script
  double radius = 0.0;                      // [m] of the probe; the path is that of its lowest point
  double clearance = 0.03;                  // [m] above the surface before and after
  double depth = 0.008;                     // [m] below the rest surface while sliding
  double press_from = 0.0, press_to = 0.0;  // [s]
  double lift_from = 0.0, lift_to = 0.0;    // [s]
  std::vector<dvec3> through;               // [m] points near the surface; the slide goes through their projections
  std::vector<double> at;  // [s] when it reaches each of them; in between, the speed rises and falls smoothly
};

// 100 rows a second. Position, velocity and acceleration are continuous in time wherever the surface is smooth.
Path trace(const Solid& solid, const Stroke& stroke);

}  // namespace pliant::generate
