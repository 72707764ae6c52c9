// What a Session says of the devices' servos, and tells them (pliant/session.h).
#include <cmath>

#include "engine/session_parts.h"

namespace pliant {

Result<Servo*> Session::Parts::find_servo(const std::string& name, const char* what) {
  SessionEffector* const effector = find_effector(name);
  if (!effector) return unknown_effector(name);
  if (Servo* const servo = effector->link.servo()) return servo;
  return Error{std::string(what) + " `" + name + "`",
               effector->link ? "its driver says no rate, so that the touch clock calls it without a servo"
                              : "has no driver; call Session::connect() first"};
}

Status Session::guard(const std::string& name, const GuardParameters& parameters) {
  SessionEffector* const effector = parts_->find_effector(name);
  if (!effector) return parts_->unknown_effector(name);
  const GuardParameters& p = parameters;
  for (const double value : {p.max_force, p.max_torque, p.max_velocity, p.ramp})
    if (!(value >= 0.0) || !std::isfinite(value))
      return Error{"Session::guard `" + name + "`", "a limit is negative or no number; say 0 for the device's own"};
  if (!(p.slew > 0.0)) return Error{"Session::guard `" + name + "`", "slew must be above 0 N/s"};
  effector->guard = parameters;
  return Done{};
}

Result<DeviceReport> Session::device_state(const std::string& name) const {
  auto servo = parts_->find_servo(name, "Session::device_state");
  if (!servo) return servo.error();
  return (*servo)->report();
}

Status Session::arm(const std::string& name) {
  auto servo = parts_->find_servo(name, "Session::arm");
  if (!servo) return servo.error();
  (*servo)->arm();
  return Done{};
}

Status Session::disarm(const std::string& name) {
  auto servo = parts_->find_servo(name, "Session::disarm");
  if (!servo) return servo.error();
  (*servo)->disarm();
  return Done{};
}

void Session::emergency_stop() {
  for (SessionEffector& effector : parts_->effectors)
    if (Servo* const servo = effector.link.servo()) servo->stop();
}

}  // namespace pliant
