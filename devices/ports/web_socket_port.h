// Text messages of a web socket (RFC 6455) to a service of this machine or network; Debian's libwebsockets. One thread
// at a time.
#pragma once

#include <memory>
#include <string>

#include "devices/ports/packet_port.h"

namespace pliant {

class WebSocketPort final : public PacketPort {
 public:
  // Waits for the connection, at most `seconds`. Messages longer than `longest` bytes end it with an error.
  static Result<std::unique_ptr<WebSocketPort>> connect(const std::string& host, int port, double seconds,
                                                        std::size_t longest);
  ~WebSocketPort() override;
  Status send(std::span<const std::uint8_t> text) override;
  Result<std::size_t> receive(std::span<std::uint8_t> into, double seconds) override;
  int file() const override;  // for whole frames of another process (web_socket_frame)

  struct Line;  // the part that libwebsockets calls

 private:
  explicit WebSocketPort(std::unique_ptr<Line> line);
  std::unique_ptr<Line> line_;
};

// One text message of a client as it stands on the wire; its length, 0: `into` is too small. Masked by zeros.
std::size_t web_socket_frame(std::span<const std::uint8_t> text, std::span<std::uint8_t> into);

}  // namespace pliant
