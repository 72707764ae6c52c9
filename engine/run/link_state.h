// State of a device whose driver has no servo (it reports no rate), in the terms of one that has
// (pliant/device_state.h): disconnected, active while samples arrive, tripped by an emergency stop, idle once disarmed.
// The safety layer of the touch tick guards its force; this class keeps latched states and collects the report.
#pragma once

#include <atomic>

#include "pliant/device_state.h"
#include "pliant/driver.h"
#include "runtime/exchange.h"

namespace pliant {

class LinkState {
 public:
  static constexpr double kLostAfter = 0.1;     // [s] without a sample
  static constexpr double kReportEvery = 0.05;  // [s] between reports
  static constexpr double kFadeTime = 0.5;      // [s] in which a low battery fades the force out
  static constexpr double kRise = 0.2;          // [s] in which a share taken by a warning is restored

  explicit LinkState(const DeviceCapabilities& can) : can_(can) {}

  // --- Touch clock; nothing waits or allocates
  // True if it has just been armed: its force must return through the gate.
  bool sense(const DeviceSample* sample, double now);
  bool renewed() const { return renewed_; }  // in this tick
  // [1] Share of the force that may leave after the safety layer: zero when stopped, half for a warm device, the fading
  // share within kFadeTime after a low battery.
  double may_leave(const DeviceWrench& wrench, double now);
  void rest(const DeviceSample* sample);  // in a pause, in which time stops

  // --- Thread-safe
  void arm() { orders_ |= kArm; }
  void disarm() { orders_ |= kDisarm; }
  void stop() { orders_ |= kStop; }
  const DeviceReport& report();  // from the owner's thread only

 private:
  enum Order : std::uint32_t { kArm = 1, kDisarm = 2, kStop = 4 };
  void to(DeviceState state, DeviceCause cause, double now);
  void follow_orders(double now);
  void publish_report(double now);
  void warn(double elapsed);

  DeviceCapabilities can_;
  std::atomic<std::uint32_t> orders_{0};
  TripleBuffer<DeviceReport> reports_;
  DeviceReport report_;
  double came_at_ = 0.0, reported_at_ = 0.0, now_ = 0.0;  // [s]
  double share_ = 1.0;                                    // [1] share left by the device's warnings
  std::uint64_t reported_samples_ = 0;
  bool came_ = false, latched_ = false, renewed_ = false, reported_ = false;
};

}  // namespace pliant
