#include "devices/drivers/stick_control.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace pliant {
namespace {

constexpr double kLongestStep = 0.1;  // [s]

dvec3 clipped(const dvec3& v, double dead_zone) {
  return {without_dead_zone(v.x, dead_zone), without_dead_zone(v.y, dead_zone), without_dead_zone(v.z, dead_zone)};
}

}  // namespace

Result<StickSettings> stick_settings(const std::string& driver, const DeviceWords& words, StickSettings defaults) {
  StickSettings set = defaults;
  static constexpr const char* kRateFirst[] = {"rate", "position"};
  static constexpr const char* kPositionFirst[] = {"position", "rate"};
  const Result<std::string> control = choice_of(driver, words, "control", defaults.rate ? kRateFirst : kPositionFirst);
  if (!control) return control.error();
  set.rate = *control == "rate";
  struct Number {
    const char* key;
    double least, most;
    double* value;
  };
  for (const Number& number :
       {Number{"speed", 0.001, 1.0, &set.speed}, Number{"turn", 0.01, 10.0, &set.turn},
        Number{"dead_zone", 0.0, 0.9, &set.dead_zone}, Number{"reach", 0.001, 0.5, &set.reach}}) {
    const Result<double> value = number_of(driver, words, number.key, number.least, number.most, *number.value);
    if (!value) return value.error();
    *number.value = *value;
  }
  if (!set.rate) set.extent = glm::max(set.extent, dvec3(set.reach));
  return set;
}

double without_dead_zone(double deflection, double dead_zone) {
  const double size = std::min(std::abs(deflection), 1.0);
  if (!(size > dead_zone)) return 0.0;  // also NaN
  return std::copysign((size - dead_zone) / (1.0 - dead_zone), deflection);
}

dquat rotation_by(const dvec3& vector) {
  const double angle = length(vector);
  return angle < 1e-12 ? dquat(1, 0, 0, 0) : glm::angleAxis(angle, vector / angle);
}

void StickControl::step(const dvec3& move, const dvec3& turn, bool clutch, double dt) {
  dt = std::clamp(dt, 0.0, kLongestStep);
  const double share = settings_.smooth > 0.0 ? -std::expm1(-dt / settings_.smooth) : 1.0;
  move_ += share * (clipped(move, settings_.dead_zone) - move_);
  turn_ += share * (clipped(turn, settings_.dead_zone) - turn_);
  const dvec3 most = settings_.extent;
  if (settings_.rate) {
    if (clutch) return;
    position_ = glm::clamp(position_ + settings_.speed * dt * move_, -most, most);
    rotation_ = glm::normalize(rotation_by(settings_.turn * dt * turn_) * rotation_);
    return;
  }
  const dvec3 displaced = settings_.reach * move_;
  const dquat turned = rotation_by(settings_.angle * turn_);
  if (clutch) {
    base_ = position_ - displaced;
    base_rotation_ = glm::conjugate(turned) * rotation_;
    return;
  }
  position_ = glm::clamp(base_ + displaced, -most, most);
  rotation_ = glm::normalize(turned * base_rotation_);
}

}  // namespace pliant
