// Datagrams to one peer. What comes from another address is dropped: by the kernel where the peer is known from the
// beginning, else counted.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "devices/ports/packet_port.h"

namespace pliant {

// A line that waits for its peer: until take_peer() whoever sent last is answered, after it only that one is heard.
class ListeningPort : public PacketPort {
 public:
  virtual void take_peer() = 0;  // the sender of the packet that receive() gave last
  virtual void free_peer() = 0;
  // The newest packet of someone else since the last call, while there is a peer; 0: none came. `answer` is for them.
  virtual std::size_t stranger(std::span<std::uint8_t>) { return 0; }
  virtual void answer(std::span<const std::uint8_t>) {}
  virtual std::string peer() const { return {}; }  // "192.168.1.7:40123"
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
  std::size_t stranger(std::span<std::uint8_t> into) override;
  void answer(std::span<const std::uint8_t> packet) override;
  std::string peer() const override;
  int file() const override { return connected_ ? socket_ : -1; }

  std::uint64_t strangers() const { return strangers_; }  // packets from another address than the peer's, listening
  int port() const;                                       // its own

 private:
  struct Address;
  UdpPort(int socket, std::string name);
  int socket_;
  std::string name_;  // for errors
  std::unique_ptr<Address> peer_, last_, stranger_;
  bool has_peer_ = false, connected_ = false;
  std::array<std::uint8_t, 128> strange_{};  // a question is not longer
  std::size_t strange_size_ = 0;
  std::uint64_t strangers_ = 0;
};

}  // namespace pliant
