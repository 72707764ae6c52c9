// A device of one's own: derive from Driver, register it under a name, and give it to a probe or tool by that name.
//
// Frames and units: positions in metres, world axes (right-handed, Y up), forces in newtons on the hand. Threads: open,
// capabilities and close are called by whoever calls the Session; read and write by the touch clock, a thousand times a
// second: they must return at once and never block. A driver that waits for its device does so on a thread of its own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pliant/math.h"
#include "pliant/result.h"

namespace pliant {

// What a device has sensed.
struct DeviceSample {
  dvec3 position{0};           // [m] its workspace, in world axes; DeviceParameters::scale makes it world
  dquat rotation{1, 0, 0, 0};  // device frame to world, unit
  bool ready = true;           // false: its state is not known; no force leaves for it
};

// What leaves for a device: finite, clamped, slew-limited, passive.
struct DeviceWrench {
  dvec3 force{0};   // [N] world, on the hand
  dvec3 torque{0};  // [N m] world, on the hand; only tools make any
};

struct DeviceCapabilities {
  bool senses_rotation = false;  // false: samples' rotations are not used; a tool keeps the one it has
  bool renders_force = true;     // false: it is written zero
  bool renders_torque = false;   // the same
  double max_force = 0.0;      // [N] what the device can render; 0: not said. The smaller of this and the level's holds
  double max_torque = 0.0;     // [N m] the same
  double max_stiffness = 0.0;  // [N/m] per metre of its workspace, what it can render stably; 0: not said
};

class Driver {
 public:
  virtual ~Driver() = default;
  // `id`: which of several devices, as its user wrote it after "NAME:"; may be empty.
  virtual Status open(const std::string& id) = 0;
  virtual DeviceCapabilities capabilities() const { return {}; }
  // The newest sample. False: there is none since the last call. Without one for 10 ms the device counts as lost and
  // its force is zero until its wanted force has been small again.
  virtual bool read(DeviceSample& sample) = 0;
  // Every tick, also while nothing is touched, while the session pauses, and last of all with zero.
  virtual void write(const DeviceWrench& wrench) = 0;
  virtual void close() = 0;
};

using DriverFactory = std::function<std::unique_ptr<Driver>()>;

// One line a driver. Fails on a name that is taken, empty, or holds ':'. From any thread.
Status register_driver(const std::string& name, DriverFactory factory);
// The registered names, in alphabetical order.
std::vector<std::string> driver_names();
// A new one, not opened. The error lists the names there are.
Result<std::unique_ptr<Driver>> make_driver(const std::string& name);

}  // namespace pliant
