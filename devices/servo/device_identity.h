// Which piece of hardware a device's words mean, so that two spellings of one are known for the same: an address by its
// numbers, a device file by the device behind it, however it is linked, with or without wrappers and settings.
#pragma once

#include <string>

namespace pliant {

inline constexpr const char* kNetworkPort = "17716";  // of driver "network" where none is given

// "network:here:17716", "node:188:0", "hardware:../../devices/..."; what cannot be resolved is itself. May ask a name
// server.
std::string device_identity(const std::string& device);
// Of a device file; "": there is none. Nodes of one piece of hardware (hidraw, event) are that hardware.
std::string node_identity(const std::string& path);

}  // namespace pliant
