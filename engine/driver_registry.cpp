// Drivers by name (pliant/driver.h).
#include <exception>
#include <map>
#include <mutex>

#include "pliant/driver.h"

namespace pliant {
namespace {

struct Registered {
  std::mutex mutex;
  std::map<std::string, DriverFactory> factories;
};

Registered& registered() {
  static Registered all;
  return all;
}

}  // namespace

Status register_driver(const std::string& name, DriverFactory factory) {
  const std::string where = "driver `" + name + "`";
  if (name.empty() || name.find(':') != std::string::npos)
    return Error{where, "has no usable name; give it one without ':'"};
  if (!factory) return Error{where, "has no factory; give a function that makes one"};
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  if (!all.factories.emplace(name, std::move(factory)).second)
    return Error{where, "is registered twice; give each driver a name of its own"};
  return Done{};
}

std::vector<std::string> driver_names() {
  Registered& all = registered();
  const std::lock_guard lock(all.mutex);
  std::vector<std::string> names;
  for (const auto& [name, factory] : all.factories) names.push_back(name);
  return names;
}

Result<std::unique_ptr<Driver>> make_driver(const std::string& name) {
  const std::string where = "driver `" + name + "`";
  DriverFactory factory;
  {
    Registered& all = registered();
    const std::lock_guard lock(all.mutex);
    if (const auto found = all.factories.find(name); found != all.factories.end()) factory = found->second;
  }
  if (factory) {
    try {
      if (std::unique_ptr<Driver> driver = factory()) return driver;
    } catch (const std::exception& thrown) {
      return Error{where, std::string("its factory threw: ") + thrown.what()};
    } catch (...) {
      return Error{where, "its factory threw something unknown"};
    }
    return Error{where, "its factory made nothing; return a driver from it"};
  }
  std::string names;
  for (const std::string& known : driver_names()) names += (names.empty() ? "" : ", ") + known;
  return Error{
      where, names.empty() ? "no driver is registered; call register_driver first" : "unknown; drivers are: " + names};
}

}  // namespace pliant
