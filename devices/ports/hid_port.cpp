#include "devices/ports/hid_port.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <hidapi/hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>

namespace pliant {
namespace {

struct Closer {
  void operator()(hid_device* device) const { hid_close(device); }
};
using Handle = std::unique_ptr<hid_device, Closer>;

// hidapi has global state while it lists and opens.
std::mutex& hidapi_mutex() {
  static std::mutex mutex;
  return mutex;
}

std::string narrow(const wchar_t* text) {
  std::string ascii;
  for (; text && *text; ++text) ascii += (*text >= 0x20 && *text < 0x7f) ? static_cast<char>(*text) : '?';
  return ascii;
}

bool fits(const hid_device_info& info, std::span<const HidMatch> matches) {
  return std::any_of(matches.begin(), matches.end(), [&](const HidMatch& match) {
    return info.vendor_id == match.vendor &&
           (match.products.empty() ||
            std::find(match.products.begin(), match.products.end(), info.product_id) != match.products.end()) &&
           (match.page == 0 || info.usage_page == match.page) && (match.usage == 0 || info.usage == match.usage);
  });
}

std::string why_not(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return cure_for_open(path, errno);
  ::close(file);
  return {};
}

class HidPort final : public PacketPort {
 public:
  HidPort(Handle in, Handle out, std::string path)
      : guard_(::open(path.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC)),
        in_(std::move(in)),
        out_(std::move(out)),
        path_(std::move(path)) {}
  ~HidPort() override {
    if (guard_ >= 0) ::close(guard_);
  }
  int file() const override { return guard_; }
  std::string node() const override { return path_; }

  Status send(std::span<const std::uint8_t> packet) override {
    if (hid_write(out_.get(), packet.data(), packet.size()) < 0) return gone();
    return Done{};
  }
  Result<std::size_t> receive(std::span<std::uint8_t> into, double seconds) override {
    const int wait = static_cast<int>(std::ceil(std::clamp(seconds, 0.0, 60.0) * 1000.0));
    const int length = hid_read_timeout(in_.get(), into.data(), into.size(), wait);
    if (length < 0) return gone();
    return static_cast<std::size_t>(length);
  }
  Result<std::size_t> feature(std::uint8_t number, std::span<std::uint8_t> into) override {
    if (into.empty()) return std::size_t(0);
    into[0] = number;
    const int length = hid_get_feature_report(out_.get(), into.data(), into.size());
    if (length < 0) return refused(number);
    return static_cast<std::size_t>(length);
  }
  Status set_feature(std::span<const std::uint8_t> report) override {
    if (report.empty() || hid_send_feature_report(out_.get(), report.data(), report.size()) < 0)
      return refused(report.empty() ? 0 : report[0]);
    return Done{};
  }
  // hidapi 0.13 does not provide it; the kernel exposes it in sysfs.
  std::vector<std::uint8_t> descriptor() override {
    std::ifstream file("/sys/class/hidraw/" + path_.substr(path_.rfind('/') + 1) + "/device/report_descriptor",
                       std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  Error gone() const { return Error{path_, "the device is gone", "plug it in again"}; }
  Error refused(std::uint8_t number) const {
    return Error{path_, fmt::format("refuses feature report {}", number), "plug the device in again"};
  }

  // Extra descriptor for a guard process, because hidapi does not expose its own.
  int guard_ = -1;
  // One per direction: hidapi keeps the last error in its handle, and sending may happen on another thread.
  Handle in_, out_;
  std::string path_;
};

}  // namespace

std::string cure_for_open(const std::string& path, int error) {
  if (error == EACCES || error == EPERM)
    return fmt::format(
        "you may not open {}; put Pliant's rules at {} (`cmake --install` does), run `udevadm control "
        "--reload`, and plug the device in again",
        path, kUdevRules);
  if (error == ENOENT || error == ENODEV || error == ENXIO)
    return fmt::format("{} is gone; plug the device in again", path);
  if (error == EBUSY) return fmt::format("another program holds {}; close it", path);
  return fmt::format("{} cannot be opened ({}); plug the device in again", path, std::strerror(error));
}

std::vector<HidFound> find_hid(std::span<const HidMatch> matches) {
  const std::lock_guard lock(hidapi_mutex());
  std::vector<HidFound> found;
  if (hid_init() != 0) return found;
  hid_device_info* const all = hid_enumerate(0, 0);
  for (const hid_device_info* info = all; info; info = info->next) {
    const std::string path = info->path ? info->path : "";
    const auto same = [&](const HidFound& other) { return other.path == path; };
    if (!fits(*info, matches) || path.empty() || std::any_of(found.begin(), found.end(), same)) continue;
    const std::string serial = narrow(info->serial_number), product = narrow(info->product_string);
    const std::string name =
        product.empty() ? fmt::format("{:04x}:{:04x}", info->vendor_id, info->product_id) : product;
    found.push_back({path, serial.empty() ? path : serial, name, info->vendor_id, info->product_id,
                     info->bus_type == HID_API_BUS_BLUETOOTH, why_not(path),
                     fmt::format("{:04x}:{:04x}:{}", info->vendor_id, info->product_id, serial)});
  }
  hid_free_enumeration(all);
  std::sort(found.begin(), found.end(), [](const HidFound& a, const HidFound& b) {
    return a.path.size() != b.path.size() ? a.path.size() < b.path.size() : a.path < b.path;
  });
  for (std::size_t i = 0; i < found.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (found[i].id == found[j].id) found[i].id = found[i].path;
  return found;
}

Result<std::unique_ptr<PacketPort>> open_hid(std::span<const HidMatch> matches, const std::string& id) {
  const std::vector<HidFound> all = find_hid(matches);
  const HidFound* chosen = nullptr;
  std::string ids;
  for (const HidFound& found : all) {
    ids += (ids.empty() ? "" : ", ") + found.id;
    const bool named = id == found.id || id == found.path;
    if (!chosen && (named || (id.empty() && found.missing.empty()))) chosen = &found;
  }
  if (!chosen && id.empty() && !all.empty()) chosen = &all.front();
  if (!chosen)
    return Error{id.empty() ? "device" : "device `" + id + "`", ids.empty() ? "none is there" : "is not there",
                 ids.empty() ? "plug it in and switch it on" : "there are: " + ids, "device.missing"};
  if (!chosen->missing.empty()) return Error{chosen->name, chosen->missing};
  const std::lock_guard lock(hidapi_mutex());
  Handle in(hid_open_path(chosen->path.c_str())), out(hid_open_path(chosen->path.c_str()));
  if (!in || !out) return Error{chosen->name, cure_for_open(chosen->path, errno)};
  return std::unique_ptr<PacketPort>(std::make_unique<HidPort>(std::move(in), std::move(out), chosen->path));
}

}  // namespace pliant
