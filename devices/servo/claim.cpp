#include "devices/servo/claim.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <mutex>
#include <set>
#include <utility>

#include "devices/servo/device_identity.h"

namespace pliant {
namespace {

#ifdef __EMSCRIPTEN__
constexpr bool kHasSockets = false;  // a claim holds within the module; the browser opens the device for its page
#else
constexpr bool kHasSockets = true;
#endif

std::mutex& claims_mutex() {
  static std::mutex mutex;
  return mutex;
}
std::set<std::string>& claims() {
  static std::set<std::string> taken;
  return taken;
}

// Shortens a long identity to its beginning and a hash (FNV-1a) of all of it.
std::string lock_name(const std::string& identity) {
  constexpr std::size_t kMost = 64;
  std::uint64_t sum = 0xcbf29ce484222325ull;
  for (const char c : identity) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return identity.size() <= kMost ? "pliant-device-" + identity
                                  : fmt::format("pliant-device-{}-{:016x}", identity.substr(0, kMost), sum);
}

struct LockAddress {
  sockaddr_un address{};
  socklen_t size = 0;
  explicit LockAddress(const std::string& name) {
    address.sun_family = AF_UNIX;
    std::copy(name.begin(), name.end(), address.sun_path + 1);  // a first byte of zero: no file
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  }
  const sockaddr* raw() const { return reinterpret_cast<const sockaddr*>(&address); }
};

// " (process 1234)", or "" if the kernel does not provide it.
std::string holder(const LockAddress& lock) {
  const int asking = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (asking < 0) return {};
  ucred who{};
  socklen_t size = sizeof who;
  const bool known = ::connect(asking, lock.raw(), lock.size) == 0 &&
                     ::getsockopt(asking, SOL_SOCKET, SO_PEERCRED, &who, &size) == 0 && who.pid > 0;
  ::close(asking);
  return known ? fmt::format(" (process {})", who.pid) : std::string();
}

}  // namespace

DeviceClaim& DeviceClaim::operator=(DeviceClaim&& other) noexcept {
  if (this != &other) {
    release();
    held_ = std::exchange(other.held_, {});
  }
  return *this;
}

Status DeviceClaim::take(const std::string& device) {
  release();
  return add(device_identity(device), device);
}

Status DeviceClaim::take_opened(const std::string& device, const Driver& driver) {
  const std::string node = driver.node();
  const std::string identity = node.empty() ? std::string() : node_identity(node);
  const auto is_it = [&](const Held& held) { return held.identity == identity; };
  if (identity.empty() || std::any_of(held_.begin(), held_.end(), is_it)) return Done{};
  return add(identity, device);
}

Status DeviceClaim::add(const std::string& identity, const std::string& device) {
  const std::string where = "device `" + device + "`";
  const std::lock_guard hold(claims_mutex());
  if (claims().contains(identity))
    return Error{where, "moves another effector already", "call Session::release() for that one first"};
  const LockAddress lock(lock_name(identity));
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const bool free =
      !kHasSockets || (socket >= 0 && ::bind(socket, lock.raw(), lock.size) == 0 && ::listen(socket, 8) == 0);
  if (!free) {
    const int fault = errno;
    if (socket >= 0) ::close(socket);
    if (socket >= 0 && fault == EADDRINUSE)
      return Error{where, "is held by another program" + holder(lock), "end that one first"};
    return Error{where,
                 fmt::format("is not opened, because it cannot be known whether another program has it ({})",
                             std::strerror(fault)),
                 "raise ulimit -n"};
  }
  claims().insert(identity);
  held_.push_back({identity, socket});
  return Done{};
}

void DeviceClaim::release() noexcept {
  if (held_.empty()) return;
  const std::lock_guard hold(claims_mutex());
  for (const Held& held : held_) {
    ::close(held.lock);
    claims().erase(held.identity);
  }
  held_.clear();
}

}  // namespace pliant
