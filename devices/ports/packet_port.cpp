#include "devices/ports/packet_port.h"

namespace pliant {

Result<std::size_t> PacketPort::feature(std::uint8_t, std::span<std::uint8_t>) {
  return Error{"device", "has no feature reports on this line"};
}
Status PacketPort::set_feature(std::span<const std::uint8_t>) {
  return Error{"device", "has no feature reports on this line"};
}

}  // namespace pliant
