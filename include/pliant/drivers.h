// The shipped drivers, in the package's component `devices` (docs/devices.md): SpaceMouse, gamepads, Falcon, Haply and
// others.
#pragma once

namespace pliant {

// Registers each driver by its name (pliant/driver.h); a second call does nothing. Call before Session::connect.
void register_all_drivers();

}  // namespace pliant
