// A port that sends packets on a separate thread, newest only. For devices whose packets are states (a rumble, a
// trigger) and may take longer to send than the touch clock can wait.
#pragma once

#include <memory>

#include "devices/ports/packet_port.h"

namespace pliant {

// send() stores a packet of at most kLongestNewest bytes and returns at once, without a lock; it fails after the port
// has failed. Called by one thread. The destructor waits until the last stored packet is sent.
inline constexpr std::size_t kLongestNewest = 128;
std::unique_ptr<PacketPort> newest_port(std::unique_ptr<PacketPort> line);

}  // namespace pliant
