#include "engine/run/driver_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "devices/believable.h"
#include "devices/guard/last_resort.h"
#include "devices/servo/device_identity.h"
#include "systems/device/device_model.h"
#include "systems/device/softening.h"
#include "systems/safety/safety.h"

namespace pliant {

DriverLink& DriverLink::operator=(DriverLink&& other) noexcept {
  if (this == &other) return *this;
  close();
  claim_ = std::move(other.claim_);
  driver_ = std::move(other.driver_);
  servo_ = std::exchange(other.servo_, nullptr);
  can_ = std::exchange(other.can_, {});
  placed_rotation_ = other.placed_rotation_;
  written_at_ = other.written_at_;
  late_ = other.late_;
  longest_ = other.longest_;
  ready_ = other.ready_;
  state_ = std::move(other.state_);
  watch_ = std::move(other.watch_);
  note_ = std::move(other.note_);
  return *this;
}

Status DriverLink::connect(std::unique_ptr<Driver> driver, const std::string& id, const std::string& where,
                           const std::string& claimed, const GuardParameters& guard) {
  DeviceClaim claim;
  bool opened = false;
  const auto failed = [&](const std::string& what) {
    try {
      if (opened) driver->close();
    } catch (...) {  // closed regardless
    }
    return Error{where, what};
  };
  DeviceCapabilities can;
  Servo* servo = nullptr;
  try {
    // Claimed before opening: a line that two programs query at once answers neither.
    if (!claimed.empty() && device_identity(claimed) != "simulated")
      if (Status taken = claim.take(claimed); !taken) return taken;
    if (Status status = driver->open(id); !status) return status;
    opened = true;
    can = driver->capabilities();
    if (const std::string wrong = beyond_belief(can); !wrong.empty()) return failed(wrong);
    if (can.simulated || !renders(can)) {
      claim.release();  // any number of programs may read it
    } else if (!claimed.empty()) {
      if (Status taken = claim.take_opened(claimed, *driver); !taken) {
        driver->close();
        return taken;
      }
    }
    if (wants_servo(can)) {
      auto served = std::make_unique<Servo>(std::move(driver), guard);
      servo = served.get();
      driver = std::move(served);
      servo->adopt();
      can = servo->capabilities();
    }
  } catch (const std::exception& thrown) {
    return failed(std::string("the driver threw: ") + thrown.what());
  } catch (...) {
    return failed("the driver threw something unknown");
  }
  close();
  claim_ = std::move(claim);
  driver_ = std::move(driver);
  servo_ = servo;
  can_ = can;
  if (servo_) return Done{};
  state_ = std::make_unique<LinkState>(can);
  watch_ = std::make_unique<LineWatch>();
  note_ = watch_->start(*driver_, can_);
  if (renders(can_) && !guard_to_the_last(*driver_)) note_ = "more devices are open than a crash handler knows";
  return Done{};
}

void DriverLink::close() noexcept {
  if (driver_) {
    zero();
    if (!servo_) let_go_of(*driver_);
    if (watch_) watch_->end();
    try {
      driver_->close();
    } catch (...) {  // closed regardless
    }
  }
  driver_.reset();
  state_.reset();
  watch_.reset();
  note_.clear();
  servo_ = nullptr;
  can_ = {};
  claim_.release();
}

void DriverLink::begin(HapticDevice& device, dquat placed, dvec3 middle) {
  device.can = driver_ ? can_ : kNoDriver;
  device.grips = driver_ && can_.senses_grip;
  device.workspace = driver_ ? device.scale : 1.0;
  device.origin = driver_ && can_.workspace != dvec3(0) ? middle : dvec3(0);
  device.force_sent = device.torque_sent = dvec3(0);
  placed_rotation_ = placed;
  written_at_ = late_ = 0;
  longest_ = 0.0;
  ready_ = false;
}

// Without a new sample the device keeps its last one; once that is old, the safety layer treats the device as lost.
void DriverLink::read(HapticDevice& device, Tick tick) {
  DeviceSample sample;
  if (servo_ && !servo_->runs()) servo_->advance(tick.time);
  const bool fresh = driver_->read(sample);
  if (state_ && state_->sense(fresh ? &sample : nullptr, tick.time)) ready_ = false;  // force returns through the gate
  if (fresh) {
    device.position = device.origin + device.workspace * sample.position;
    if (!can_.senses_rotation)
      device.rotation = placed_rotation_;
    else if (plausible_rotation(sample.rotation))
      device.rotation = sample.rotation / glm::length(sample.rotation);
    else
      device.rotation = sample.rotation;  // no rotation: the pose is rejected and counted
    if (std::isfinite(sample.grip)) device.grip = std::clamp(sample.grip, 0.0, 1.0);
    device.sensed_at = tick.time;
    ready_ = sample.ready && !(state_ && state_->renewed());
  }
  device.status = ready_ ? DeviceStatus::kReady : DeviceStatus::kLost;
}

void DriverLink::write(World& world, Entity effector, Entity entity, Tick tick) {
  HapticDevice& device = world.registry.get<HapticDevice>(entity);
  const DeviceWrench wrench{device.force_sent, device.torque_sent};
  if (!can_.simulated && !(servo_ && servo_->runs())) {
    const std::uint64_t now = now_ns();
    const double since = written_at_ > 0 ? static_cast<double>(now - written_at_) * 1e-9 : 0.0;
    written_at_ = now;
    longest_ = std::max(longest_, since);
    late_ += since > kForceHolds;
  }
  if (!servo_) {
    const double share = state_->may_leave(wrench, tick.time);
    device.force_sent *= share;
    device.torque_sent *= share;
    if (!all_made_safe()) driver_->write({device.force_sent, device.torque_sent});
    watch_->beat(*driver_, tick.time);
    return;
  }
  if (device.status != DeviceStatus::kReady)
    servo_->write({});
  else
    servo_->write_model(device_model(world, effector, entity, tick), wrench);
  const bool felt = servo_->felt();
  if (SafetyState* const safety = safety_of(world, effector)) safety->felt = felt;
  if (!felt) device.force_sent = device.torque_sent = dvec3(0);
}

std::optional<Note> DriverLink::late_note(const std::string& name) const {
  if (late_ == 0) return std::nullopt;
  return Note{
      fmt::format("device of `{}`: {} times more than {:.0f} ms went by between two ticks ({:.0f} ms at most), and a "
                  "device lets go of a force that is not renewed by then: there nothing was felt",
                  name, late_, 1e3 * kForceHolds, 1e3 * longest_),
      "run in real time (without --lockstep, or with Session::start()), or have less in the scene", "device.late",
      name};
}

void DriverLink::idle() {
  written_at_ = 0;  // a pause is not a late write
  DeviceSample sample;
  const bool fresh = driver_->read(sample);
  if (state_) state_->rest(fresh ? &sample : nullptr);
  driver_->write({});
  if (watch_) watch_->beat(*driver_, 0.0);
}

const std::string& DriverLink::note() const {
  return servo_ ? servo_->note() : note_;
}

const DeviceReport& DriverLink::report() {
  static const DeviceReport none;
  return servo_ ? servo_->report() : state_ ? state_->report() : none;
}
void DriverLink::arm() {
  if (servo_) servo_->arm();
  if (state_) state_->arm();
}
void DriverLink::disarm() {
  if (servo_) servo_->disarm();
  if (state_) state_->disarm();
}
void DriverLink::stop() {
  if (servo_) servo_->stop();
  if (state_) state_->stop();
}

void DriverLink::zero() noexcept {
  if (!driver_) return;
  try {
    driver_->write({});
  } catch (...) {  // after a failure the device's watchdog ends the force
  }
}

Status DriverLink::start() {
  return servo_ ? servo_->start() : Status(Done{});
}
void DriverLink::halt() noexcept {
  if (servo_) servo_->halt();
}
Status DriverLink::may_step() const {
  return servo_ ? servo_->can_advance() : Status(Done{});
}

}  // namespace pliant
