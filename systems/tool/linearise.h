// The soft clock's side of the exchange with the touch clock (methods.md 2.6, 2.8, 2.9). Three calls, in this order, in
// a soft step of T [s]:
//   take_inputs       before the bodies' free_step: where the hands are
//   linearise         after apply_impulses and before the bodies advance: what the step says about each handle
//   publish_models    last: brings what was found up to date with the handle's path since, and publishes it
// A soft step that begins with an input of time t ends at t: the device is led back by T times its velocity, so that it
// arrives at the step's end where it was sensed; once the touch clock moves the handle, the handle itself is led there,
// since two handles on one device would each swing in their own way. What has happened since is in
// ToolTouchState::path.
#pragma once

#include "components/world.h"

namespace pliant {

// [m] The longest way that a handle is to go in the soft step that is about to begin. Takes the newest inputs in.
double farthest_way(World& world);

// All do nothing where no tools are prepared. Of a step in parts (soft_step.h), take_inputs leads each handle its share
// of what is left.
void take_inputs(World& world, double T);
void linearise(World& world, double T);
void publish_models(World& world);

}  // namespace pliant
