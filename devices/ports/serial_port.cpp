#include "devices/ports/serial_port.h"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace pliant {
namespace {

speed_t speed_of(int baud) {
  switch (baud) {
    case 9600:
      return B9600;
    case 115200:
      return B115200;
    case 230400:
      return B230400;
    case 460800:
      return B460800;
    case 921600:
      return B921600;
    case 1000000:
      return B1000000;
    case 2000000:
      return B2000000;
    case 4000000:
      return B4000000;
    default:
      return B0;
  }
}

}  // namespace

Result<std::unique_ptr<SerialPort>> SerialPort::open(const std::string& path, int baud) {
  const speed_t speed = speed_of(baud);
  if (speed == B0)
    return Error{path, std::to_string(baud) + " is no speed",
                 "it must be one of 9600, 115200, 230400, 460800, 921600, 1000000, 2000000, 4000000"};
  const int file = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) {
    const int fault = errno;
    if (fault == EACCES || fault == EPERM)
      return Error{path, "may not be opened by this user",
                   "install the udev rule 70-pliant.rules and plug it in again, or join the group dialout"};
    if (fault == ENOENT) return Error{path, "is not there", "plug the device in, and see `pliant devices`"};
    return Error{path, std::string("cannot be opened: ") + std::strerror(fault)};
  }
  std::unique_ptr<SerialPort> port(new SerialPort(file, path));
  termios line{};
  if (tcgetattr(file, &line) != 0) return Error{path, "is no serial line", "give one such as /dev/ttyACM0"};
  cfmakeraw(&line);
  line.c_cflag = (line.c_cflag & ~static_cast<tcflag_t>(CSTOPB | CRTSCTS)) | CLOCAL | CREAD;
  line.c_cc[VMIN] = line.c_cc[VTIME] = 0;
  if (cfsetspeed(&line, speed) != 0 || tcsetattr(file, TCSANOW, &line) != 0)
    return Error{path, "does not take " + std::to_string(baud) + " baud", "give another speed"};
  tcflush(file, TCIOFLUSH);
  return port;
}

SerialPort::~SerialPort() {
  ::close(file_);
}

Status SerialPort::send(std::span<const std::uint8_t> packet) {
  while (!packet.empty()) {
    const ssize_t sent = ::write(file_, packet.data(), packet.size());
    if (sent > 0) {
      packet = packet.subspan(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN) {
      pollfd wait{file_, POLLOUT, 0};
      if (::poll(&wait, 1, 100) == 0) return Error{path_, "does not take what is sent"};
    } else if (errno != EINTR) {
      return Error{path_, std::string("is gone: ") + std::strerror(errno)};
    }
  }
  return Done{};
}

Result<std::size_t> SerialPort::receive(std::span<std::uint8_t> into, double seconds) {
  pollfd wait{file_, POLLIN, 0};
  const int ready = ::poll(&wait, 1, static_cast<int>(std::ceil(std::clamp(seconds, 0.0, 1e6) * 1e3)));
  if (ready == 0 || (ready < 0 && errno == EINTR)) return std::size_t{0};
  const ssize_t got = ::read(file_, into.data(), into.size());
  if (got > 0) return static_cast<std::size_t>(got);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return std::size_t{0};
  return Error{path_, "is gone", "it was unplugged"};
}

}  // namespace pliant
