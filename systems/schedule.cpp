// READ FIRST. What happens, in order.
#include "systems/schedule.h"

#include "systems/device/devices.h"
#include "systems/touch/collision.h"
#include "systems/touch/dynamics.h"
#include "systems/touch/force_field.h"
#include "systems/touch/friction_feedback.h"
#include "systems/touch/press.h"
#include "systems/touch/publish.h"

namespace pliant {

// The touch tick (P1). Nothing in it allocates, locks, logs, throws or touches a file.
std::vector<System<World>> touch_schedule() {
  return {
      {"read_devices", read_devices},  // HapticDevice -> Probe pose and velocity
      {"collision", collision},        // Probe x Deformable -> Contact {triangle, barycentrics, normal, height}
      {"press", press},                // flesh of tools x Deformable -> Contact
      {"force_field", force_field},    // Contacts -> amplitudes (small LCP); wakes the zones within reach
      {"dynamics", dynamics},          // awake zones: exact step, stream = targets + residual; rest sleeps
      {"friction_feedback", friction_feedback},  // local law at the virtual vertex, bristle friction -> Probe force
      {"write_devices", write_devices},          // safety: finite, clamp, slew, engage, passivity -> device
      {"publish", publish_paced},                // dirty zones, probe poses and forces -> TripleBuffer
  };
}

}  // namespace pliant
