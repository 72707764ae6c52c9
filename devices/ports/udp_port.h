// Datagrams to one peer. Packets from other addresses are dropped: by the kernel if the peer is known at the start,
// else counted.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "devices/ports/packet_port.h"

namespace pliant {

// A port that waits for its peer: until take_peer() replies go to the last sender, afterwards only the peer is
// received.
class ListeningPort : public PacketPort {
 public:
  virtual void take_peer() = 0;  // makes the sender of the last received packet the peer
  virtual void free_peer() = 0;
  // The newest packet of another sender since the last call, while there is a peer; 0: none. `answer` replies to it.
  virtual std::size_t stranger(std::span<std::uint8_t>) { return 0; }
  virtual void answer(std::span<const std::uint8_t>) {}
  virtual std::string peer() const { return {}; }  // "192.168.1.7:40123"
};

// "ADDRESS:PORT", "[IPV6]:PORT" or "PORT", which is on this machine.
struct UdpAddress {
  std::string host = "127.0.0.1";
  std::string port;
};
// The error quotes `text` and the correct syntax.
Result<UdpAddress> parse_udp_address(const std::string& text);

class UdpPort final : public ListeningPort {
 public:
  // To a peer, from a port chosen by the system. With a local peer nothing from outside is received.
  static Result<std::unique_ptr<UdpPort>> connect(const UdpAddress& peer);
  // Waits for a peer. Port 0: chosen by the system, see port().
  static Result<std::unique_ptr<UdpPort>> listen(const UdpAddress& own);
  ~UdpPort() override;

  // A full buffer or a closed peer port counts as packet loss, not as an error.
  Status send(std::span<const std::uint8_t> packet) override;
  Result<std::size_t> receive(std::span<std::uint8_t> into, double seconds) override;
  void take_peer() override;
  void free_peer() override;
  std::size_t stranger(std::span<std::uint8_t> into) override;
  void answer(std::span<const std::uint8_t> packet) override;
  std::string peer() const override;
  int file() const override { return connected_ ? socket_ : -1; }

  std::uint64_t strangers() const {
    return strangers_;
  }                  // while listening: packets from other addresses than the
                     // peer's
  int port() const;  // its own

 private:
  struct Address;
  UdpPort(int socket, std::string name);
  int socket_;
  std::string name_;  // for errors
  std::unique_ptr<Address> peer_, last_, stranger_;
  bool has_peer_ = false, connected_ = false;
  std::array<std::uint8_t, 128> strange_{};  // requests are not longer
  std::size_t strange_size_ = 0;
  std::uint64_t strangers_ = 0;
};

}  // namespace pliant
