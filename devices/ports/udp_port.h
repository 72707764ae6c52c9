// Datagrams to one peer. What comes from another address is dropped and counted.
#pragma once

#include <memory>
#include <string>

#include "devices/ports/packet_port.h"

namespace pliant {

// A line that waits for its peer: until take_peer() whoever sent last is answered, after it only that one is heard.
class ListeningPort : public PacketPort {
 public:
  virtual void take_peer() = 0;  // the sender of the packet that receive() gave last
  virtual void free_peer() = 0;
};

// "ADDRESS:PORT", "[IPV6]:PORT" or "PORT", which is on this machine; the rest of the two.
struct UdpAddress {
  std::string host = "127.0.0.1";
  std::string port;
};
// The error names `text` and how an address is written.
Result<UdpAddress> parse_udp_address(const std::string& text);

class UdpPort final : public ListeningPort {
 public:
  // To a peer, from a port of the system's choice. Of a peer on this machine nobody outside it is heard.
  static Result<std::unique_ptr<UdpPort>> connect(const UdpAddress& peer);
  // Waits for a peer. Port 0: of the system's choice, see port().
  static Result<std::unique_ptr<UdpPort>> listen(const UdpAddress& own);
  ~UdpPort() override;

  // A full buffer or a peer that has no such port now are losses, as on any network, and no error.
  Status send(std::span<const std::uint8_t> packet) override;
  Result<std::size_t> receive(std::span<std::uint8_t> into, double seconds) override;
  void take_peer() override;
  void free_peer() override;

  std::uint64_t strangers() const { return strangers_; }  // packets that came from another address than the peer's
  int port() const;                                       // its own

 private:
  struct Address;
  UdpPort(int socket, std::string name);
  int socket_;
  std::string name_;  // for errors
  std::unique_ptr<Address> peer_, last_;
  bool has_peer_ = false;
  std::uint64_t strangers_ = 0;
};

}  // namespace pliant
