// The state of a run's devices as plain values for display: a panel draws it (viewer/ui/device_list.h) in the window of
// a run and in the editor.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pliant/device_state.h"
#include "pliant/driver.h"

namespace pliant {

struct DeviceView {
  std::string effector;  // the probe or tool that it moves
  std::string id;        // "falcon:0|scale=2"
  std::string name;      // display name
  DeviceCapabilities can;
  DeviceReport report;
};

struct DevicesView {
  std::vector<DeviceView> devices;
  struct Other {
    std::string effector, source;  // "probe_b", "orbit"
  };
  std::vector<Other> others;         // hands that no device moves
  std::vector<DeviceInfo> unusable;  // present, but cannot be opened
  std::uint64_t late_ticks = 0;      // of the touch clock
};

// Commands from the user interface.
struct DeviceOrders {
  std::vector<std::string> arm, disarm, stop;  // by effector
  bool stop_all = false;
  bool allow = false, decline = false;  // answers to the question whether a level may use the devices that it requests
  bool any() const { return stop_all || !arm.empty() || !disarm.empty() || !stop.empty(); }
};

}  // namespace pliant
