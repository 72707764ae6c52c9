// A device of one's own: derive from Driver, register it under a name, and give it to a probe or tool by that name.
//
// Frames and units: positions in metres, world axes (right-handed, Y up), forces in newtons on the hand. Threads: open,
// capabilities and close are called by whoever calls the Session; read and write by one clock, a thousand times a
// second or as often as the device says (DeviceCapabilities::rate): they must return at once and never block. A driver
// that waits for its device does so in wait(), or on a thread of its own.
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

// What a device has sensed.
struct DeviceSample {
  dvec3 position{0};           // [m] its workspace, in world axes; DeviceParameters::scale makes it world
  dquat rotation{1, 0, 0, 0};  // device frame to world, unit
  bool ready = true;           // false: its state is not known; no force leaves for it
  double grip = 0.0;           // [1] how far it is closed, 0 to 1; of a trigger, how far it is pulled
  std::uint32_t buttons = 0;   // those that are down, bit by bit, as the driver numbers them
  double time = 0.0;           // [s] when it was sensed, of the monotonic clock; 0: when it was read
  std::uint32_t warnings = 0;  // bits of DeviceWarning
  double battery = -1.0;       // [1] 0 to 1; below 0: it does not say
  bool charging = false;
};

// What a device says of itself. Warm: its force is lowered. Battery low: its force fades, and it is to be armed again.
enum DeviceWarning : std::uint32_t { kDeviceWarm = 1u, kDeviceBatteryLow = 2u };

// What leaves for a device: finite, clamped, slew-limited, passive.
struct DeviceWrench {
  dvec3 force{0};     // [N] world, on the hand
  dvec3 torque{0};    // [N m] world, on the hand; only tools make any
  double grip = 0.0;  // [N] that opens the grip, or resists the trigger
};

// The force near a pose, linear: what the servo of a device goes by between two touch ticks, and what a device that
// renders it itself is told. With dx = x - position, r the rotation vector from `rotation` to the device's, v and w its
// velocities: force + force_by_position dx + force_by_turn r + force_by_velocity v, and so the torque. Of a passive
// surface the matrices are negative semi-definite.
struct DeviceModel {
  dvec3 position{0};              // [m]
  dquat rotation{1, 0, 0, 0};     // unit
  DeviceWrench wrench;            // there
  dmat3 force_by_position{0.0};   // [N/m]
  dmat3 force_by_turn{0.0};       // [N/rad]
  dmat3 torque_by_position{0.0};  // [N m/m]
  dmat3 torque_by_turn{0.0};      // [N m/rad]
  dmat3 force_by_velocity{0.0};   // [N s/m]
  dmat3 torque_by_spin{0.0};      // [N m s/rad]
  double time = 0.0;              // [s] when it was made, of the monotonic clock
  dvec3 velocity{0};              // [m/s] of what is touched: dx and v are against it
  dvec3 carried{0};               // [m/s] the part of it that may do work: of a surface with a prescribed motion
  dvec3 weight{0};                // [N] part of the force that may do work: of a tool that nothing carries
  double max_force = 0.0;         // [N] the level's limit, which holds of what the model gives as well; 0: none
  double max_torque = 0.0;        // [N m] the same
};

// Who decides when the next sample is due.
enum class DeviceLoop : std::uint8_t {
  kOurs,     // read() has the newest at any time
  kReply,    // the device answers each write: wait() returns when it has
  kCallback  // the maker's library calls: run() is handed what to do there
};

struct DeviceCapabilities {
  bool senses_rotation = false;  // false: samples' rotations are not used; a tool keeps the one it has
  bool renders_force = true;     // false: it is written zero
  bool renders_torque = false;   // the same
  double max_force = 0.0;      // [N] what the device can render; 0: not said. The smaller of this and the level's holds
  double max_torque = 0.0;     // [N m] the same
  double max_stiffness = 0.0;  // [N/m] per metre of its workspace, what it can render stably; 0: not said
  bool senses_position = true;     // false: it only points, or pulls a trigger
  bool senses_grip = false;        // DeviceSample::grip
  bool renders_grip = false;       // DeviceWrench::grip
  bool renders_vibration = false;  // contact and texture are felt as a shaking
  bool resists_only = false;       // it brakes, and cannot push: it is never written a force along the motion
  double continuous_force = 0.0;   // [N] that it bears for ever; 0: not said
  double max_velocity = 0.0;       // [m/s] faster, and its force is switched off until it is armed again; 0: not said
  dvec3 workspace{0};    // [m] half of its extents, about where the scene put what it moves; 0: not said, its poses are
                         // in the world's frame
  double rate = 0.0;     // [Hz] of samples, and of its servo; 0: the touch clock's, without a thread of its own
  double latency = 0.0;  // [s] from a write to the sample that knows of it; 0: not said
  DeviceLoop loop = DeviceLoop::kOurs;
  bool simulated = false;  // it has no motors: any number may open the same one
  double max_grip = 0.0;   // [N] of DeviceWrench::grip; 0: not said
  double damping = 0.0;    // [N s/m] of its mechanics in a light hand: bounds its stiffness by its rate; 0: not said
};

// A line on which another process may write, and what it writes to switch the force off.
struct SafeLine {
  int descriptor = -1;
  std::array<std::uint8_t, 256> bytes{};
  std::size_t size = 0;  // of `bytes`
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

  // Of kReply: returns when a sample is there, or after `seconds`. On the servo's thread alone, which may wait.
  virtual void wait(double seconds);
  // Of kCallback, after open(): `tick` reads, decides and writes, on the library's thread and at its rate, until
  // close(). Fails where the library does not run it.
  virtual Status run(std::function<void()> tick);
  // True: the device renders the model itself, and write() need not be called for it. `wrench` is what the model gives
  // where the device is now, after every limit.
  virtual bool write_model(const DeviceModel& model, const DeviceWrench& wrench);
  // Motors off, brakes on, at once: after a fault and last of all. Of a device without such a thing, a zero wrench. A
  // wrench other than zero that is written later switches them on again. From the thread that writes, and from a signal
  // handler after a crash: there, what needs a lock or memory may be left out.
  virtual void make_safe() noexcept;
  // True where there is such a line, after open(): a process of its own watches this one and uses it.
  virtual bool safe_line(SafeLine& line) const;
  // The device file that it has opened, by which two names of one device are known for the same; "": it has none.
  virtual std::string node() const;
  // True: its line is dead, so that read() has nothing any more; from the thread that reads. One that was made by its
  // name is then closed, and opened until it is there again, on another thread and while no other function is called.
  virtual bool gone() const;
};

using DriverFactory = std::function<std::unique_ptr<Driver>()>;

// One device that is there, or that would be with what is missing.
struct DeviceInfo {
  std::string driver, id;  // "driver:id" opens it; without an id there is nothing to open yet
  std::string name;        // as people call it
  std::string missing;     // why it cannot be opened now, and the cure, as one sentence; "": it can
  DeviceCapabilities can;
  // Which piece of hardware, "VENDOR:PRODUCT:SERIAL", where several drivers may find the same; "": not known.
  std::string hardware;
  bool general = false;  // its driver takes whatever is of its kind: one that is made for the hardware goes before it
  std::string also;      // "driver:id" of such a one that takes it, too: "" in what a lister returns
};
using DeviceLister = std::function<std::vector<DeviceInfo>()>;

// One line a driver. Fails on a name that is taken, empty, or holds ':'. From any thread. `lister`: what is there now;
// none: its devices cannot be listed, and are opened by name.
Status register_driver(const std::string& name, DriverFactory factory, DeviceLister lister = {});
// The registered names, in alphabetical order.
std::vector<std::string> driver_names();
// A new one, not opened. The error lists the names there are.
Result<std::unique_ptr<Driver>> make_driver(const std::string& name);
// What every registered driver finds now, in the order of their names, each piece of hardware once.
std::vector<DeviceInfo> list_devices();

}  // namespace pliant
