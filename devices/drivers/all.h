// Every driver that ships, registered by name (pliant/driver.h).
#pragma once

namespace pliant {

// Once; a second call does nothing. Programs that hold devices call it before they open a level.
void register_all_drivers();

}  // namespace pliant
