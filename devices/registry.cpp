// Drivers by name (pliant/driver.h).
#include <algorithm>
#include <exception>
#include <map>
#include <mutex>

#include "pliant/driver.h"

namespace pliant {
namespace {

struct Registered {
  std::mutex mutex;
  struct Entry {
    DriverFactory factory;
    DeviceLister lister;
  };
  std::map<std::string, Entry> drivers;
};

Registered& registered() {
  static Registered all;
  return all;
}

// If either has no serial number, vendor and product are compared.
bool same_hardware(const std::string& a, const std::string& b) {
  constexpr std::size_t kKind = 10;  // of "054c:0ce6:"
  if (a.size() < kKind || b.size() < kKind || a.compare(0, kKind, b, 0, kKind) != 0) return false;
  return a.size() == kKind || b.size() == kKind || a == b;
}

std::vector<DeviceInfo> each_once(std::vector<DeviceInfo> found) {
  std::vector<DeviceInfo> once;
  for (const bool general : {false, true})
    for (DeviceInfo& info : found) {
      if (info.general != general) continue;
      DeviceInfo* made_for = nullptr;
      for (DeviceInfo& other : once)
        if (general && !other.general && other.also.empty() && same_hardware(info.hardware, other.hardware))
          made_for = &other;
      if (made_for)
        made_for->also = info.id.empty() ? info.driver : info.driver + ":" + info.id;
      else
        once.push_back(std::move(info));
    }
  std::stable_sort(once.begin(), once.end(),
                   [](const DeviceInfo& a, const DeviceInfo& b) { return a.driver < b.driver; });
  return once;
}

}  // namespace

void Driver::wait(double) {}
Status Driver::run(std::function<void()>) {
  return Error{"driver", "has no loop of its own", "derive run(), or say another DeviceLoop"};
}
bool Driver::write_model(const DeviceModel&, const DeviceWrench&) {
  return false;
}
bool Driver::safe_line(SafeLine&) const {
  return false;
}
std::string Driver::node() const {
  return {};
}
bool Driver::gone() const {
  return false;
}
void Driver::make_safe() noexcept {
  try {
    write({});
  } catch (...) {  // the device's own watchdog removes the force
  }
}

Status register_driver(const std::string& name, DriverFactory factory, DeviceLister lister) {
  const std::string where = "driver `" + name + "`";
  if (name.empty() || name.find(':') != std::string::npos)
    return Error{where, "has no usable name", "give it one without ':'"};
  if (!factory) return Error{where, "has no factory", "give a function that makes one"};
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  if (!all.drivers.emplace(name, Registered::Entry{std::move(factory), std::move(lister)}).second)
    return Error{where, "is registered twice", "give each driver a name of its own"};
  return Done{};
}

std::vector<std::string> driver_names() {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  std::vector<std::string> names;
  for (const auto& [name, entry] : all.drivers) names.push_back(name);
  return names;
}

Result<std::unique_ptr<Driver>> make_driver(const std::string& name) {
  const std::string where = "driver `" + name + "`";
  DriverFactory factory;
  {
    Registered& all = registered();
    const std::lock_guard lock(all.mutex);
    if (const auto found = all.drivers.find(name); found != all.drivers.end()) factory = found->second.factory;
  }
  if (factory) {
    try {
      if (std::unique_ptr<Driver> driver = factory()) return driver;
    } catch (const std::exception& thrown) {
      return Error{where, std::string("its factory threw: ") + thrown.what()};
    } catch (...) {
      return Error{where, "its factory threw something unknown"};
    }
    return Error{where, "its factory made nothing", "return a driver from it"};
  }
  std::string names;
  for (const std::string& known : driver_names()) names += (names.empty() ? "" : ", ") + known;
  if (names.empty()) return Error{where, "no driver is registered", "call register_driver first", "device.driver"};
  return Error{where, "unknown", "drivers are: " + names, "device.driver"};
}

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceLister> listers;
  {
    Registered& all = registered();
    const std::lock_guard lock(all.mutex);
    for (const auto& [name, entry] : all.drivers)
      if (entry.lister) listers.push_back(entry.lister);
  }
  std::vector<DeviceInfo> found;
  for (const DeviceLister& lister : listers)
    for (DeviceInfo& info : lister()) found.push_back(std::move(info));
  return each_once(std::move(found));
}

}  // namespace pliant
