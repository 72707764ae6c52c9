// READ FIRST. The order of systems.
#include "systems/schedule.h"

#include "systems/device/devices.h"
#include "systems/effects/effects.h"
#include "systems/soft/publish_soft.h"
#include "systems/soft/soft_step.h"
#include "systems/tool/pull.h"
#include "systems/tool/tool_feedback.h"
#include "systems/tool/tool_step.h"
#include "systems/touch/collide/collision.h"
#include "systems/touch/feed/press.h"
#include "systems/touch/feed/publish.h"
#include "systems/touch/model/dynamics.h"
#include "systems/touch/model/force_field.h"
#include "systems/touch/model/friction_feedback.h"
#include "systems/touch/prepare/move_objects.h"
#include "systems/touch/prepare/vary_surfaces.h"

namespace pliant {

// The touch tick (P1). Nothing in it allocates, locks, logs, throws or touches a file.
std::vector<System<World>> touch_schedule() {
  return {
      {"read_devices", read_devices},            // HapticDevice -> Probe pose and velocity
      {"move_objects", move_objects},            // Kinematic -> Pose, velocity and box of animated and scripted nodes
      {"vary_surfaces", vary_surfaces},          // Varying -> Deformable: keys that an animation varies
      {"collision", collision},                  // Probe x Deformable -> Contacts {foot, normal, height}
      {"press", press},                          // tissue of tools x Deformable -> Contact
      {"force_field", force_field},              // Contacts -> amplitudes (small LCP); wakes the zones within reach
      {"dynamics", dynamics},                    // awake zones: exact step, stream = targets + residual; rest sleeps
      {"friction_feedback", friction_feedback},  // minus the gradient of one stored energy, friction -> Probe force
      {"effects", effects},                      // Effect x Probe -> minus the gradient of its potential, drag
      {"tool_feedback", tool_feedback},          // device pose -> 6-DoF handle on its model -> Handle6 wrench
      {"write_devices", write_devices},          // safety: finite, clamp, slew, engage, passivity -> device
      {"publish", publish_paced},                // dirty zones, probe poses and forces -> TripleBuffer
  };
}

// The soft step (P2): implicit over T, for all dynamic bodies. Its clock may allocate and be late.
std::vector<System<World>> soft_schedule() {
  return {
      {"take_edits", take_edits},            // ParameterEdit -> bodies
      {"read_tool_input", read_tool_input},  // ToolInput -> target pose of each handle from the device
      {"free_motion", free_motion},          // assemble, factorise, v* of every body without contacts
      {"pull_bodies", pull_bodies},          // mouse springs on bodies -> v* of those
      {"find_contacts", find_contacts},    // surfaces -> ContactPoint {points, normal, gap}; on P1 surfaces by P1's law
      {"solve_contacts", solve_contacts},  // Delassus operator, Signorini and Coulomb -> impulses, velocities
      {"linearise_tools", linearise_tools},  // response of the step at each handle -> HandleModel
      {"advance_bodies", advance_bodies},    // x += T v; displaces P1 surfaces
      {"publish_tools", publish_tools},      // HandleModel -> touch clock
      {"publish_soft", publish_soft},        // surfaces, contacts, handles -> visual clock; presses -> touch clock
  };
}

}  // namespace pliant
