// The soft clock's side of the exchange with the touch clock (methods.md 2.6, 2.8, 2.9). Three calls, in this order, in
// a soft step of T [s]:
//   take_inputs       before the bodies' free_step: target poses of the handles
//   linearise         after apply_impulses and before the bodies advance: model of each handle
//   publish_models    last: updates the models with the handle's path since, and publishes them
//
// A soft step that begins with an input of time t ends at t. The device is extrapolated back by T times its velocity,
// so that it ends the step at its sensed pose. Once the touch clock moves the handle, the handle's pose is prescribed
// instead, since two handles on one device would oscillate independently. The path since then is in
// ToolTouchState::path.
#pragma once

#include "components/world.h"

namespace pliant {

// [m] The longest distance that a handle is to move in the next soft step. Acquires the newest inputs.
double farthest_way(World& world);

// All do nothing without prepared tools. If a step is run in parts (soft_step.h), take_inputs moves each handle by one
// part of the remaining distance.
void take_inputs(World& world, double T);
void linearise(World& world, double T);
void publish_models(World& world);

}  // namespace pliant
