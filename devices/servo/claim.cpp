#include "devices/servo/claim.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cctype>
#include <cstdlib>
#include <mutex>
#include <set>
#include <utility>

namespace pliant {
namespace {

std::mutex& claims_mutex() {
  static std::mutex mutex;
  return mutex;
}
std::set<std::string>& claims() {
  static std::set<std::string> taken;
  return taken;
}

// In the folder of whoever is logged in, else of all.
std::string lock_file(const std::string& device) {
  const char* const folder = std::getenv("XDG_RUNTIME_DIR");
  std::string name;
  for (const char c : device) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.';
    static constexpr char kHex[] = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    name += plain ? std::string(1, c) : std::string{'_', kHex[byte >> 4], kHex[byte & 15]};
  }
  return std::string(folder && *folder ? folder : "/tmp") + "/pliant-device-" + name.substr(0, 200) + ".lock";
}

}  // namespace

DeviceClaim::DeviceClaim(DeviceClaim&& other) noexcept
    : device_(std::exchange(other.device_, {})), lock_(std::exchange(other.lock_, -1)) {}
DeviceClaim& DeviceClaim::operator=(DeviceClaim&& other) noexcept {
  if (this != &other) {
    release();
    device_ = std::exchange(other.device_, {});
    lock_ = std::exchange(other.lock_, -1);
  }
  return *this;
}

Status DeviceClaim::take(const std::string& device) {
  release();
  const std::lock_guard hold(claims_mutex());
  if (!claims().insert(device).second)
    return Error{"device `" + device + "`",
                 "moves another effector already; call Session::release() for that one first"};
  const std::string file = lock_file(device);
  // Where no file can be made there is nothing to lock: the claim holds within this program.
  lock_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    ::close(lock_);
    lock_ = -1;
    claims().erase(device);
    return Error{"device `" + device + "`",
                 "is held by another program (its lock is " + file + "); end that one first"};
  }
  device_ = device;
  return Done{};
}

void DeviceClaim::release() noexcept {
  if (device_.empty()) return;
  const std::lock_guard hold(claims_mutex());
  if (lock_ >= 0) ::close(lock_);
  lock_ = -1;
  claims().erase(device_);
  device_.clear();
}

}  // namespace pliant
