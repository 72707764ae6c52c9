// The local model that a device's servo uses until the next touch tick: the sent force and its derivatives.
//
// Probe: the slopes of its contacts' laws along their normals, and of their bristles across them while they stick, and
// those of effects that hold it. The rotation of the normals is left out, so that the matrices are negative
// semi-definite. Tool: the coupling to its
// handle, which continues with its velocity. Where the safety layer reduced the wanted force, the slopes are reduced
// with it. A clipped force has no slope along it; behind a closed gate all slopes are zero.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

// Called after write_devices. In the driver's metres; `time` is the tick's.
DeviceModel device_model(const World& world, Entity effector, Entity device, Tick tick);

}  // namespace pliant
