// One driver on one device of the world: its samples come in before a tick, what left safety goes out after it. A
// device with a rate gets a servo in front (devices/servo/servo.h). For a Session and for a program's own loop.
#pragma once

#include <memory>
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

  // Opens it. `where` opens the error. `claimed`: "driver:id" that nobody else may have meanwhile; "": a driver of
  // one's own. `placed`: the rotation of a device that senses none.
  Status connect(std::unique_ptr<Driver> driver, const std::string& id, const std::string& where,
                 const std::string& claimed = {}, const GuardParameters& guard = {});
  void close() noexcept;  // written zero, and gone
  // Its owner's. What stands between it and a hand: of its servo, or of a driver without one (link_state.h).
  const DeviceReport& report();
  void arm();
  void disarm();
  void stop();  // from any thread: no force until it is armed
  bool connected() const { return driver_ != nullptr; }
  explicit operator bool() const { return connected(); }
  const DeviceCapabilities& can() const { return can_; }
  const std::string& note() const;         // what is not as it might be, once it is connected; may be empty
  Servo* servo() const { return servo_; }  // null: its driver is called by the touch clock

  // `device` is moved by this driver, or by none, from now on.
  // `middle` [m] world: where the workspace of a driver that says one has its own; of others, it is in the world's
  // frame.
  void begin(HapticDevice& device, dquat placed, dvec3 middle);
  void forget() { ready_ = false; }  // its pose, until it says another

  // --- Around a tick. None allocates or waits.
  // In lockstep the servo's periods until this tick run here.
  void read(HapticDevice& device, Tick tick);
  // Where the device's guard lets nothing leave, the device's force_sent is zero afterwards.
  void write(World& world, Entity effector, Entity device, Tick tick);
  // What a person should know after a run: a device lets go of a force that nobody renews. One sentence, or none.
  std::string late_note(const std::string& name) const;
  void idle();  // instead of both, while a loop is paused
  void zero() noexcept;

  // --- Real time, around the touch clock's; without a servo nothing to do
  Status start();
  void halt() noexcept;
  Status may_step() const;  // an error of a device that cannot run in lockstep

 private:
  DeviceClaim claim_;
  std::unique_ptr<Driver> driver_;
  Servo* servo_ = nullptr;
  DeviceCapabilities can_;
  dquat placed_rotation_{1, 0, 0, 0};
  std::uint64_t written_at_ = 0, late_ = 0;  // [ns]; writes later than kForceHolds after the one before
  double longest_ = 0.0;                     // [s] between two writes
  bool ready_ = false;                       // as it said last, since a pause
  // Of a driver without a servo.
  std::unique_ptr<LinkState> state_;
  std::unique_ptr<LineWatch> watch_;
  std::string note_;
};

}  // namespace pliant
