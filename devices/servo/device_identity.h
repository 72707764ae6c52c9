// The identity of the hardware that a device's text refers to, so that two spellings are recognised as the same.
// Addresses are resolved; device files are identified by device number, through links; wrappers and options are
// ignored.
#pragma once

#include <string>

namespace pliant {

inline constexpr const char* kNetworkPort = "17716";  // of driver "network" where none is given

// "network:here:17716", "node:188:0"; the text itself if it cannot be resolved. May query a name server.
std::string device_identity(const std::string& device);
// Of a device file; "": there is none. Nodes of one piece of hardware (hidraw, event) are that hardware.
std::string node_identity(const std::string& path);

}  // namespace pliant
