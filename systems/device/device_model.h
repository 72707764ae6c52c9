// What the servo of a device goes by until the next touch tick: the force that was sent, and how it changes near.
//
// Of a probe: the slopes of its contacts' laws along their normals, and of their bristles across them where they stick;
// what turns the normals is left out, so that the matrices are negative semi-definite. Of a tool: the coupling to its
// handle, which goes on with its velocity. Where the safety layer took something from the wanted force, the slopes are
// lowered with it: of a clipped force nothing along it is left, behind a closed gate nothing at all.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

// After write_devices. In the driver's metres; `time` is the tick's.
DeviceModel device_model(const World& world, Entity effector, Entity device, Tick tick);

}  // namespace pliant
