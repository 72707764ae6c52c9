// What a person holds against the surface. A point, or a sphere.
#pragma once

#include <cstdint>

#include "components/math.h"
#include "runtime/entity.h"

namespace pliant {

// Rate: touch. Writer: read_devices (pose, velocity), friction_feedback (force).
struct Probe {
  double radius = 0.0;            // [m] 0: a point
  vec3 color{0.9f, 0.35f, 0.1f};  // linear RGB
  Entity device = kNoEntity;      // has a HapticDevice; kNoEntity: nobody moves it

  dvec3 position{0};           // [m] world
  dquat rotation{1, 0, 0, 0};  // world
  dvec3 velocity{0};           // [m/s] world
  dvec3 previous{0};           // [m] world, one tick ago: the start of the swept segment
  bool placed = false;         // false until the device has given a first pose; then `previous` means something
  bool fresh = false;          // this tick's pose is the first one

  dvec3 force{0};  // [N] world, on the probe: the sum over its contacts, before the safety layer
};

}  // namespace pliant
