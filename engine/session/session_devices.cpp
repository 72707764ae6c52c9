// State and control of the devices' servos in a Session (pliant/session.h).
#include <cmath>

#include "engine/session/session_run.h"

namespace pliant {

Result<DriverLink*> SessionRun::find_link(const std::string& name, const char* what) {
  SessionEffector* const effector = find_effector(name);
  if (!effector) return unknown_effector(name);
  if (effector->link) return &effector->link;
  return Error{std::string(what) + " `" + name + "`", "has no driver", "call Session::connect() first"};
}

Status Session::guard(const std::string& name, const GuardParameters& parameters) {
  SessionEffector* const effector = run_->find_effector(name);
  if (!effector) return run_->unknown_effector(name);
  const GuardParameters& p = parameters;
  for (const double value : {p.max_force, p.max_torque, p.max_velocity, p.ramp})
    if (!(value >= 0.0) || !std::isfinite(value))
      return Error{"Session::guard `" + name + "`", "a limit is negative or no number", "say 0 for the device's own"};
  if (!(p.slew > 0.0)) return Error{"Session::guard `" + name + "`", "slew must be above 0 N/s"};
  effector->guard = parameters;
  return Done{};
}

Result<DeviceReport> Session::device_state(const std::string& name) const {
  auto link = run_->find_link(name, "Session::device_state");
  if (!link) return link.error();
  return (*link)->report();
}

Status Session::arm(const std::string& name) {
  auto link = run_->find_link(name, "Session::arm");
  if (!link) return link.error();
  (*link)->arm();
  return Done{};
}

Status Session::disarm(const std::string& name) {
  auto link = run_->find_link(name, "Session::disarm");
  if (!link) return link.error();
  (*link)->disarm();
  return Done{};
}

void Session::emergency_stop() {
  for (SessionEffector& effector : run_->effectors) effector.link.stop();
}

}  // namespace pliant
