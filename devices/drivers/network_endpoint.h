// The device side of driver "network", for the program of such a device (examples/network_device is the same in one
// file, without Pliant). It serves one engine at a time; another one gets the name of the one that uses the device.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "devices/drivers/network_frame.h"
#include "devices/ports/udp_port.h"

namespace pliant {

class NetworkEndpoint {
 public:
  NetworkEndpoint(std::unique_ptr<ListeningPort> port, DeviceCapabilities can, const std::string& name,
                  std::function<double()> clock, std::optional<FrameKey> key = {});

  // Call once per period of the device's servo: receives frames, sends the device's state, and returns the force to
  // render. `now.sample` is in world axes; its time and `heard` are set here.
  DeviceWrench tick(StateFrame now);

  bool opened() const { return engine_ != 0; }
  bool closed() const { return closed_; }  // by the last engine explicitly, not by time-out
  const FrameCounts& counts() const { return counts_; }

 private:
  void hear(double now);
  void accept(const NetworkFrame& frame, double now);
  void answer_stranger(double now);
  void describe_to(const NetworkFrame& frame, double now);
  void reply_busy(const NetworkFrame& frame, bool stranger, double now);
  void forget();
  const FrameKey* key() const { return key_ ? &*key_ : nullptr; }
  std::size_t pack(NetworkFrame& frame, double now, FrameBytes& into);
  void send(NetworkFrame& frame, double now);

  std::unique_ptr<ListeningPort> port_;
  DeviceCapabilities can_;
  std::array<char, 32> name_{};
  std::function<double()> clock_;
  std::optional<FrameKey> key_;
  std::uint32_t own_ = 0, engine_ = 0;  // sessions; 0: none
  std::uint32_t heard_sequence_ = 0;
  std::uint64_t heard_time_us_ = 0;  // on the engine's clock
  SentTimes sent_;
  ForceFrame force_;
  bool has_force_ = false, closed_ = false;
  double heard_at_ = 0.0, force_at_ = 0.0;  // [s]
  FrameCounts counts_;
};

// The model's force at a pose and velocity; beyond `radius`, its value at that distance.
DeviceWrench model_wrench(const DeviceModel& model, double radius, const StateFrame& at);

}  // namespace pliant
