// Connects one driver to one device of the world: samples are read before a tick, the force that passed safety is
// written after it. A device with a rate gets a servo (devices/servo/servo.h). Used by Session and by a program's own
// loop.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "components/world.h"
#include "devices/guard/watchman.h"
#include "devices/servo/claim.h"
#include "devices/servo/servo.h"
#include "engine/run/link_state.h"
#include "runtime/clock.h"
#include "runtime/result.h"
#include "systems/safety/safety.h"

namespace pliant {

class DriverLink {
 public:
  DriverLink() = default;
  DriverLink(DriverLink&&) noexcept = default;
  DriverLink& operator=(DriverLink&& other) noexcept;
  ~DriverLink() { close(); }

  // Opens the driver. `where` prefixes the error. `claimed`: "driver:id" to claim exclusively; "": a driver of the
  // program's own. `placed`: the rotation of a device that senses none.
  Status connect(std::unique_ptr<Driver> driver, const std::string& id, const std::string& where,
                 const std::string& claimed = {}, const GuardParameters& guard = {});
  void close() noexcept;  // writes zero and closes
  // --- Owner's thread. State of the layer between driver and hand: of the servo, or of a driver without one
  // (link_state.h).
  const DeviceReport& report();
  void arm();
  void disarm();
  void stop();  // thread-safe: no force until it is armed
  bool connected() const { return driver_ != nullptr; }
  explicit operator bool() const { return connected(); }
  const DeviceCapabilities& can() const { return can_; }
  const std::string& note() const;         // after connect(): a deficiency of the connection; may be empty
  Servo* servo() const { return servo_; }  // null: the touch clock calls the driver

  // From now on this driver, or none, moves `device`. `middle` [m] world: place of the workspace's centre for a driver
  // that reports one; other drivers' workspaces are in the world frame.
  void begin(HapticDevice& device, dquat placed, dvec3 middle);
  void forget() { ready_ = false; }  // its pose, until the next sample

  // --- Around a tick. Nothing allocates or waits. In lockstep the servo's periods up to this tick run here.
  void read(HapticDevice& device, Tick tick);
  // If the device's guard withholds the force, the device's force_sent is zero afterwards.
  void write(World& world, Entity effector, Entity device, Tick tick);
  // Note after a run: a device drops a force that is not renewed in time. One sentence, or empty.
  std::optional<Note> late_note(const std::string& name) const;
  void idle();  // called instead of both while a loop is paused
  void zero() noexcept;

  // --- Real time, on the touch clock's start and end; does nothing without a servo.
  Status start();
  void halt() noexcept;
  Status may_step() const;  // error if the device cannot run in lockstep

 private:
  DeviceClaim claim_;
  std::unique_ptr<Driver> driver_;
  Servo* servo_ = nullptr;
  DeviceCapabilities can_;
  dquat placed_rotation_{1, 0, 0, 0};
  std::uint64_t written_at_ = 0, late_ = 0;  // [ns]; number of writes later than kForceHolds after the previous one
  double longest_ = 0.0;                     // [s] between two writes
  bool ready_ = false;                       // as of the last sample since a pause
  // Of a driver without a servo.
  std::unique_ptr<LinkState> state_;
  std::unique_ptr<LineWatch> watch_;
  std::string note_;
};

}  // namespace pliant
