// The state of a device whose driver has no servo (it says no rate), in the words of one that has
// (pliant/device_state.h): disconnected, active while samples come, tripped by an emergency stop, idle once it is
// disarmed. The safety layer of the touch tick guards its force as before; this keeps what is latched, and tells what a
// person wants to know.
#pragma once

#include <atomic>

#include "pliant/device_state.h"
#include "pliant/driver.h"
#include "runtime/exchange.h"

namespace pliant {

class LinkState {
 public:
  static constexpr double kLostAfter = 0.1;   // [s] without a sample
  static constexpr double kTellEvery = 0.05;  // [s] of reports
  static constexpr double kFadeTime = 0.5;    // [s] in which a low battery takes the force away
  static constexpr double kRise = 0.2;        // [s] in which what a warning took comes back

  explicit LinkState(const DeviceCapabilities& can) : can_(can) {}

  // --- The touch clock's; nothing waits or allocates
  // True: it has just been armed, so that its force is to come back through the gate.
  bool sense(const DeviceSample* sample, double now);
  bool renewed() const { return renewed_; }  // in this tick
  // [1] The share that may leave of what the safety layer lets through: none of what is stopped, half of it for a warm
  // device, and what a low battery has left within kFadeTime.
  double may_leave(const DeviceWrench& wrench, double now);
  void rest(const DeviceSample* sample);  // in a pause, where time stands still

  // --- Anybody's
  void arm() { orders_ |= kArm; }
  void disarm() { orders_ |= kDisarm; }
  void stop() { orders_ |= kStop; }
  const DeviceReport& report();  // one thread's, its owner's

 private:
  enum Order : std::uint32_t { kArm = 1, kDisarm = 2, kStop = 4 };
  void to(DeviceState state, DeviceCause cause, double now);
  void follow_orders(double now);
  void tell(double now);
  void warn(double elapsed);

  DeviceCapabilities can_;
  std::atomic<std::uint32_t> orders_{0};
  TripleBuffer<DeviceReport> reports_;
  DeviceReport report_;
  double came_at_ = 0.0, told_at_ = 0.0, now_ = 0.0;  // [s]
  double share_ = 1.0;                                // [1] that the device's warnings leave
  std::uint64_t told_samples_ = 0;
  bool came_ = false, latched_ = false, renewed_ = false, told_ = false;
};

}  // namespace pliant
