// State of one probe or tool after a tick: a row of forces.csv. Filled by systems/device/reading.h.
#pragma once

#include "components/world.h"

namespace pliant {

struct ProbeReading {
  dvec3 position{0};  // [m] world
  bool in_contact = false;
  Entity object = kNoEntity;      // of the contact with the largest normal force; also while only inside
                                  // (Contact::state)
  double depth = 0.0;             // [m] below the undeformed surface along the interpolated normal; 0 when outside
  double height = 0.0;            // [m] of the surface there, <= 0 pushed in
  dvec3 normal{0};                // [1] world; 0 when outside
  dvec3 force{0};                 // [N] world, on the probe: sent to the hand (after safety)
  double normal_force = 0.0;      // [N] magnitude of its part along the normal
  double tangential_force = 0.0;  // [N] magnitude of the rest
};

}  // namespace pliant
