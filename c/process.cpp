// Version, log, signals and drivers of the process.
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "c/border.h"
#include "pliant/content.h"
#include "pliant/drivers.h"

using namespace pliant::c;

namespace {

// A driver of C functions.
class DriverOfC : public pliant::Driver {
 public:
  explicit DriverOfC(const pliant_driver& functions) : of_(functions) {}

  pliant::Status open(const std::string& id) override {
    char sentence[256] = "";
    if (of_.open(of_.user, id.c_str(), &device_, sentence, sizeof sentence) == 0) return pliant::Done{};
    sentence[sizeof sentence - 1] = '\0';
    return pliant::Error{"driver `" + id + "`", *sentence ? sentence : "its `open` failed", "", "device.refused"};
  }
  pliant::DeviceCapabilities capabilities() const override {
    pliant::DeviceCapabilities can;
    can.senses_rotation = of_.senses_rotation != 0;
    can.renders_force = of_.renders_force != 0;
    can.renders_torque = of_.renders_torque != 0;
    can.max_force = of_.max_force;
    can.max_torque = of_.max_torque;
    can.max_stiffness = of_.max_stiffness;
    can.max_velocity = of_.max_velocity;
    can.rate = of_.rate;
    return can;
  }
  bool read(pliant::DeviceSample& sample) override {
    pliant_device_sample c = sample_to_c(pliant::DeviceSample{});
    const int got = of_.read(device_, &c);
    if (got < 0) throw std::runtime_error("the driver's `read` returned " + std::to_string(got));
    if (got == 0) return false;
    sample.position = of_c(c.pose.position);
    sample.rotation = of_c(c.pose.rotation);
    sample.ready = c.ready != 0;
    sample.grip = c.grip;
    sample.time = c.time;
    sample.battery = c.battery;
    sample.buttons = c.buttons;
    sample.warnings = c.warnings;
    return true;
  }
  void write(const pliant::DeviceWrench& wrench) override {
    const pliant_wrench c{to_c(wrench.force), to_c(wrench.torque)};
    of_.write(device_, &c);
  }
  void close() override { of_.close(device_); }

 private:
  pliant_driver of_;
  void* device_ = nullptr;
};

thread_local std::vector<pliant::DeviceInfo> listed;

}  // namespace

const char* pliant_version(void) {
  return PLIANT_VERSION;
}

uint32_t pliant_abi_version(void) {
  return PLIANT_ABI_VERSION;
}

pliant_status pliant_set_log(pliant_log_function log, void* user) {
  return border(__func__, [&] {
    if (!log) return pliant::set_log({});
    pliant::set_log([log, user](pliant::LogLevel level, const std::string& sentence) {
      log(user, static_cast<int32_t>(level), sentence.c_str());
    });
  });
}

void pliant_make_devices_safe(void) {
  pliant::make_devices_safe();
}

void pliant_make_devices_safe_on_signals(void) {
  border(__func__, [] { pliant::make_devices_safe_on_signals(); });
}

pliant_status pliant_set_limit_factor(double factor) {
  return border(__func__, [&] {
    if (!(factor >= 1e-6 && factor <= 1000.0))
      throw Misuse{"`factor` must be between 1e-6 and 1000", "", "call.number"};
    pliant::set_limit_factor(factor);
  });
}

pliant_status pliant_register_all_drivers(void) {
  return border(__func__, [] { pliant::register_all_drivers(); });
}

pliant_status pliant_register_driver(const char* name, const pliant_driver* driver) {
  return border(__func__, [&] {
    const pliant_driver& functions = sized(driver, "driver");
    if (!functions.open || !functions.read || !functions.write || !functions.close)
      throw_null("driver->open, read, write, close");
    for (const double value :
         {functions.max_force, functions.max_torque, functions.max_stiffness, functions.max_velocity, functions.rate})
      at_least_zero(value, "a limit of the driver");
    check(
        pliant::register_driver(text(name, "name"), [copy = functions] { return std::make_unique<DriverOfC>(copy); }));
  });
}

pliant_status pliant_list_devices(size_t* count) {
  return border(__func__, [&] {
    needed(count, "count");
    listed = pliant::list_devices();
    *count = listed.size();
  });
}

pliant_status pliant_device(size_t index, pliant_device_info* out) {
  return border(__func__, [&] {
    sized(out, "out");
    throw_unless_below(index, listed.size(), "call pliant_list_devices on this thread first");
    const pliant::DeviceInfo& info = listed[index];
    *out = {sizeof *out,         info.can.renders_force, info.can.renders_torque, info.can.senses_rotation,
            info.driver.c_str(), info.id.c_str(),        info.name.c_str(),       info.missing.c_str(),
            info.can.max_force,  info.can.rate};
  });
}

pliant_status pliant_export_recording(const char* recording, const char* csv) {
  return border(__func__, [&] { check(pliant::export_recording(text(recording, "recording"), text(csv, "csv"))); });
}
