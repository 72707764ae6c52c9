// A line whose packets leave on a thread of its own, the newest only: for devices whose packets are states (a rumble, a
// trigger) and may take longer to leave than the touch clock can wait.
#pragma once

#include <memory>

#include "devices/ports/packet_port.h"

namespace pliant {

// send() keeps a packet of at most kLongestNewest bytes and returns at once, without a lock; it fails once the line has
// failed. One thread sends. The last packet kept has left when the port is destroyed.
inline constexpr std::size_t kLongestNewest = 128;
std::unique_ptr<PacketPort> newest_port(std::unique_ptr<PacketPort> line);

}  // namespace pliant
