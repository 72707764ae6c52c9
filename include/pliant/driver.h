// Custom device drivers: derive from Driver, register it under a name, and connect a probe or tool by that name.
//
// Frames and units: positions in metres, world axes (right-handed, Y up), forces in newtons on the hand. Threads: open,
// capabilities and close run on the thread that calls the Session. read and write run on one clock, at 1 kHz or at
// DeviceCapabilities::rate; they must return at once and never block. A driver that waits for its device does so in
// wait(), or on its own thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pliant/math.h"
#include "pliant/result.h"

namespace pliant {

// One sample of a device.
struct DeviceSample {
  dvec3 position{0};           // [m] in its workspace, world axes; DeviceParameters::scale converts to world
  dquat rotation{1, 0, 0, 0};  // device frame to world, unit
  bool ready = true;           // false: its state is unknown; no force is rendered for it
  double grip = 0.0;           // [1] closing of the grip, or pull of the trigger, 0 to 1
  std::uint32_t buttons = 0;   // bit mask of pressed buttons, numbered by the driver
  double time = 0.0;           // [s] time of sensing, monotonic clock; 0: time of reading
  std::uint32_t warnings = 0;  // bits of DeviceWarning
  double battery = -1.0;       // [1] 0 to 1; below 0: unknown
  bool charging = false;
};

// Warnings of a device. Warm: its force is lowered. Battery low: its force fades out, and it must be armed again.
enum DeviceWarning : std::uint32_t { kDeviceWarm = 1u, kDeviceBatteryLow = 2u };

// The force sent to a device: finite, clamped, slew-limited, passive.
struct DeviceWrench {
  dvec3 force{0};     // [N] world, on the hand
  dvec3 torque{0};    // [N m] world, on the hand; only from tools
  double grip = 0.0;  // [N] opens the grip, or resists the trigger
};

// A linear force model around a pose. The servo uses it between two touch ticks; a device that renders the model itself
// receives it. With dx = x - position, r the rotation vector from `rotation` to the device's, v and w its velocities:
// force + force_by_position dx + force_by_turn r + force_by_velocity v; torque likewise. For a passive surface the
// matrices are negative semi-definite.
struct DeviceModel {
  dvec3 position{0};              // [m]
  dquat rotation{1, 0, 0, 0};     // unit
  DeviceWrench wrench;            // at this pose
  dmat3 force_by_position{0.0};   // [N/m]
  dmat3 force_by_turn{0.0};       // [N/rad]
  dmat3 torque_by_position{0.0};  // [N m/m]
  dmat3 torque_by_turn{0.0};      // [N m/rad]
  dmat3 force_by_velocity{0.0};   // [N s/m]
  dmat3 torque_by_spin{0.0};      // [N m s/rad]
  double time = 0.0;              // [s] time of creation, monotonic clock
  dvec3 velocity{0};              // [m/s] of the touched object: dx and v are relative to it
  dvec3 carried{0};               // [m/s] part of it that may do work: prescribed motion of a surface
  dvec3 weight{0};                // [N] part of the force that may do work: weight of a tool that is not carried
  double max_force = 0.0;         // [N] the level's limit, which also limits the model's force; 0: none
  double max_torque = 0.0;        // [N m] the same
  bool easing = false;            // the force fades in after a stall: small or not, no gate opens on it
};

// The trigger of the next sample.
enum class DeviceLoop : std::uint8_t {
  kOurs,     // read() returns the newest at any time
  kReply,    // the device answers each write: wait() returns at the answer
  kCallback  // the vendor's library calls: run() receives the callback
};

struct DeviceCapabilities {
  bool senses_rotation = false;  // false: samples' rotations are ignored; a tool keeps its own
  bool renders_force = true;     // false: zero is written
  bool renders_torque = false;   // the same
  double max_force = 0.0;        // [N] what the device can render; 0: unspecified. The smaller of this and the level's
                                 // limit applies
  double max_torque = 0.0;       // [N m] the same
  double max_stiffness = 0.0;    // [N/m] per metre of its workspace, largest stable stiffness; 0: unspecified
  bool senses_position = true;   // false: only a pointing direction, or a trigger
  bool senses_grip = false;      // DeviceSample::grip
  bool renders_grip = false;     // DeviceWrench::grip
  bool renders_vibration = false;  // contact and texture are rendered as vibration
  bool resists_only = false;       // it can only brake: it never receives a force along the motion
  double continuous_force = 0.0;   // [N] sustained limit; 0: unspecified
  double max_velocity = 0.0;       // [m/s] if faster, its force is switched off until armed again; 0: unspecified
  dvec3 workspace{0};    // [m] half extents, centred where the scene places the effector; 0: unspecified, its poses are
                         // in the world frame
  double rate = 0.0;     // [Hz] of samples and servo; 0: runs on the touch clock, without its own thread
  double latency = 0.0;  // [s] from a write to the sample that reflects it; 0: unspecified
  DeviceLoop loop = DeviceLoop::kOurs;
  bool simulated = false;  // no motors: may be opened several times
  double max_grip = 0.0;   // [N] of DeviceWrench::grip; 0: unspecified
  double damping = 0.0;    // [N s/m] of its mechanics in a light grip: with the rate it bounds the stiffness; 0:
                           // unspecified
};

// A file descriptor through which another process can switch the force off, and the bytes to write.
struct SafeLine {
  int descriptor = -1;
  std::array<std::uint8_t, 256> bytes{};
  std::size_t size = 0;  // of `bytes`
};

class Driver {
 public:
  virtual ~Driver() = default;
  // `id` selects one of several devices: the text after "NAME:"; may be empty.
  virtual Status open(const std::string& id) = 0;
  virtual DeviceCapabilities capabilities() const { return {}; }
  // The newest sample. False: none since the last call. After 10 ms without a sample the device counts as lost; its
  // force is zero until its wanted force has been small again.
  virtual bool read(DeviceSample& sample) = 0;
  // Called every tick, also without contact and while the session pauses; the last call writes zero.
  virtual void write(const DeviceWrench& wrench) = 0;
  virtual void close() = 0;

  // For kReply: returns when a sample is available, or after `seconds`. Called only on the servo's thread, which may
  // wait.
  virtual void wait(double seconds);
  // For kCallback, after open(): `tick` reads, decides and writes, on the library's thread and at its rate, until
  // close(). Error: the library does not run it.
  virtual Status run(std::function<void()> tick);
  // True: the device renders the model itself, and write() need not be called for it. `wrench` is the model's force at
  // the current pose, after every limit.
  virtual bool write_model(const DeviceModel& model, const DeviceWrench& wrench);
  // Motors off, brakes on, at once: after a fault, and as the last call. Without such a function: writes a zero wrench.
  // A later nonzero wrench switches them on again. Called on the writing thread, and from a signal handler after a
  // crash, where steps that need a lock or memory may be skipped.
  virtual void make_safe() noexcept;
  // True if available, after open(): a separate watchdog process uses it.
  virtual bool safe_line(SafeLine& line) const;
  // The device file that it has opened, by which two names of one device are known for the same; "": it has none.
  virtual std::string node() const;
  // True: its line is dead, so that read() has nothing any more; from the thread that reads. One that was made by its
  // name is then closed, and opened until it is there again, on another thread and while no other function is called.
  virtual bool gone() const;
};

using DriverFactory = std::function<std::unique_ptr<Driver>()>;

// A device that is available, or would be if `missing` were resolved.
struct DeviceInfo {
  std::string driver, id;  // "driver:id" opens it; without an id it cannot be opened yet
  std::string name;        // display name
  std::string missing;     // why it cannot be opened now, and the remedy, as one sentence; "": it can
  DeviceCapabilities can;
  // Identity of the hardware, "VENDOR:PRODUCT:SERIAL", if several drivers may find it; "": unknown.
  std::string hardware;
  bool general = false;  // a generic driver: a driver made for this hardware is preferred
  std::string also;      // "driver:id" of such a generic driver that also supports it; "" in a lister's result
};
using DeviceLister = std::function<std::vector<DeviceInfo>()>;

// Registers a driver. Error: the name is in use, empty, or contains ':'. From any thread. `lister` returns the
// available devices; without it, devices cannot be listed and are opened by name.
Status register_driver(const std::string& name, DriverFactory factory, DeviceLister lister = {});
// The registered names, in alphabetical order.
std::vector<std::string> driver_names();
// Creates one, not opened. The error lists the registered names.
Result<std::unique_ptr<Driver>> make_driver(const std::string& name);
// The devices found by all registered drivers, in the order of their names, each piece of hardware once.
std::vector<DeviceInfo> list_devices();

}  // namespace pliant
