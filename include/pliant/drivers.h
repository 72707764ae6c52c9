// The drivers that ship, of the package's component `devices` (docs/devices.md): SpaceMouse, pads, Falcon, Haply and
// on.
#pragma once

namespace pliant {

// Registers each by its name (pliant/driver.h); a second call does nothing. Before Session::connect.
void register_all_drivers();

}  // namespace pliant
