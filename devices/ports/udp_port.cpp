#include "devices/ports/udp_port.h"

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

namespace pliant {

struct UdpPort::Address {
  sockaddr_storage bytes{};
  socklen_t size = sizeof(sockaddr_storage);
  bool operator==(const Address& other) const {
    if (bytes.ss_family != other.bytes.ss_family) return false;
    if (bytes.ss_family == AF_INET) {
      const auto& a = reinterpret_cast<const sockaddr_in&>(bytes);
      const auto& b = reinterpret_cast<const sockaddr_in&>(other.bytes);
      return a.sin_port == b.sin_port && a.sin_addr.s_addr == b.sin_addr.s_addr;
    }
    const auto& a = reinterpret_cast<const sockaddr_in6&>(bytes);
    const auto& b = reinterpret_cast<const sockaddr_in6&>(other.bytes);
    return a.sin6_port == b.sin6_port && std::memcmp(&a.sin6_addr, &b.sin6_addr, sizeof(a.sin6_addr)) == 0;
  }
  sockaddr* raw() { return reinterpret_cast<sockaddr*>(&bytes); }
};

namespace {

std::string shown(const UdpAddress& address) {
  const bool bracketed = address.host.find(':') != std::string::npos;
  return (bracketed ? "[" + address.host + "]" : address.host) + ":" + address.port;
}

// A non-blocking socket, bound or to be bound, and its resolved address.
Result<int> make_socket(const UdpAddress& address, bool passive, sockaddr_storage& found, socklen_t& size) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = passive ? AI_PASSIVE | AI_NUMERICSERV : AI_NUMERICSERV;
  addrinfo* list = nullptr;
  if (const int failed = getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &list); failed != 0)
    return Error{shown(address), std::string("cannot be resolved (") + gai_strerror(failed) + ")",
                 "give an ADDRESS:PORT of this network"};
  const int made = socket(list->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  std::memcpy(&found, list->ai_addr, list->ai_addrlen);
  size = list->ai_addrlen;
  freeaddrinfo(list);
  if (made < 0) return Error{shown(address), std::string("no socket: ") + std::strerror(errno)};
  return made;
}

}  // namespace

Result<UdpAddress> parse_udp_address(const std::string& text) {
  UdpAddress address;
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos) {
    address.host = text.substr(0, colon);
    if (address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']')
      address.host = address.host.substr(1, address.host.size() - 2);
    else if (address.host.find(':') != std::string::npos)
      address.host.clear();  // IPv6 without brackets: the port is ambiguous
  }
  address.port = colon == std::string::npos ? text : text.substr(colon + 1);
  int number = -1;
  const char* end = address.port.data() + address.port.size();
  const auto [stop, fault] = std::from_chars(address.port.data(), end, number);
  if (fault != std::errc() || stop != end || number < 0 || number > 65535 || address.host.empty())
    return Error{"'" + text + "'", "is no address",
                 "write PORT, ADDRESS:PORT or [IPV6]:PORT, such as 192.168.1.7:17716"};
  return address;
}

UdpPort::UdpPort(int socket, std::string name)
    : socket_(socket),
      name_(std::move(name)),
      peer_(std::make_unique<Address>()),
      last_(std::make_unique<Address>()),
      stranger_(std::make_unique<Address>()) {}
UdpPort::~UdpPort() {
  ::close(socket_);
}

Result<std::unique_ptr<UdpPort>> UdpPort::connect(const UdpAddress& peer) {
  Address address;
  const auto socket = make_socket(peer, false, address.bytes, address.size);
  if (!socket) return socket.error();
  std::unique_ptr<UdpPort> port(new UdpPort(*socket, shown(peer)));
  // Connecting binds to the interface that leads to the peer. With a loopback peer nothing from outside is received;
  // other senders are filtered; and a guard process may write to the socket.
  if (::connect(*socket, address.raw(), address.size) != 0)
    return Error{shown(peer), std::string("cannot be reached: ") + std::strerror(errno)};
  *port->peer_ = address;
  port->has_peer_ = port->connected_ = true;
  return port;
}

Result<std::unique_ptr<UdpPort>> UdpPort::listen(const UdpAddress& own) {
  Address address;
  const auto socket = make_socket(own, true, address.bytes, address.size);
  if (!socket) return socket.error();
  std::unique_ptr<UdpPort> port(new UdpPort(*socket, shown(own)));
  if (bind(*socket, address.raw(), address.size) != 0)
    return Error{shown(own), std::string("cannot be listened on (") + std::strerror(errno) + ")",
                 "give another PORT, or end the program that holds it"};
  return port;
}

Status UdpPort::send(std::span<const std::uint8_t> packet) {
  Address& to = has_peer_ ? *peer_ : *last_;
  if (to.bytes.ss_family == AF_UNSPEC) return Done{};  // no peer yet
  for (int tries = 0; tries < 2; ++tries) {            // the first may report the error of an earlier packet
    const ssize_t sent = connected_ ? ::send(socket_, packet.data(), packet.size(), MSG_NOSIGNAL)
                                    : ::sendto(socket_, packet.data(), packet.size(), MSG_NOSIGNAL, to.raw(), to.size);
    if (sent >= 0) return Done{};
    if (errno != ECONNREFUSED) break;
  }
  switch (errno) {
    case EAGAIN:
    case ECONNREFUSED:
    case ENOBUFS:
    case EINTR:
    case ENETUNREACH:
    case EHOSTUNREACH:
    case ENETDOWN:
      return Done{};
    default:
      break;
  }
  return Error{name_, std::string("cannot be sent to: ") + std::strerror(errno)};
}

Result<std::size_t> UdpPort::receive(std::span<std::uint8_t> into, double seconds) {
  for (;;) {
    Address from;
    const ssize_t got = ::recvfrom(socket_, into.data(), into.size(), 0, from.raw(), &from.size);
    if (got > 0) {
      if (has_peer_ && !connected_ && !(from == *peer_)) {
        ++strangers_;
        strange_size_ = std::min<std::size_t>(static_cast<std::size_t>(got), strange_.size());
        std::copy_n(into.begin(), strange_size_, strange_.begin());
        *stranger_ = from;
        continue;
      }
      *last_ = from;
      return static_cast<std::size_t>(got);
    }
    if (got == 0 || errno == ECONNREFUSED || errno == EINTR) continue;  // empty, or its port was closed earlier
    if (errno != EAGAIN) return Error{name_, std::string("cannot be heard: ") + std::strerror(errno)};
    if (seconds <= 0.0) return std::size_t{0};
    pollfd wait{socket_, POLLIN, 0};
    const int ready = ::poll(&wait, 1, static_cast<int>(std::ceil(std::min(seconds, 1e6) * 1e3)));
    if (ready == 0) return std::size_t{0};
    seconds = ready > 0 ? seconds : 0.0;  // a signal: poll once more
  }
}

void UdpPort::take_peer() {
  if (last_->bytes.ss_family == AF_UNSPEC) return;
  *peer_ = *last_;
  has_peer_ = true;
}
void UdpPort::free_peer() {
  has_peer_ = false;
}

std::size_t UdpPort::stranger(std::span<std::uint8_t> into) {
  const std::size_t size = std::min(std::exchange(strange_size_, 0), into.size());
  std::copy_n(strange_.begin(), size, into.begin());
  return size;
}
void UdpPort::answer(std::span<const std::uint8_t> packet) {
  if (stranger_->bytes.ss_family == AF_UNSPEC) return;
  (void)::sendto(socket_, packet.data(), packet.size(), MSG_NOSIGNAL, stranger_->raw(), stranger_->size);
}

std::string UdpPort::peer() const {
  char host[NI_MAXHOST] = {}, port[NI_MAXSERV] = {};
  if (!has_peer_ || getnameinfo(peer_->raw(), peer_->size, host, sizeof host, port, sizeof port,
                                NI_NUMERICHOST | NI_NUMERICSERV | NI_DGRAM) != 0)
    return {};
  return shown({host, port});
}

int UdpPort::port() const {
  Address own;
  if (getsockname(socket_, own.raw(), &own.size) != 0) return 0;
  return ntohs(own.bytes.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(own.bytes).sin6_port
                                               : reinterpret_cast<sockaddr_in&>(own.bytes).sin_port);
}

}  // namespace pliant
