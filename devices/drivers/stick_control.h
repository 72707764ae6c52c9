// Converts a deflection (of a cap or sticks) to a pose: by rate it is a velocity, by position a displacement. World
// axes: right-handed, Y up; lengths in metres of the device's workspace.
#pragma once

#include "devices/drivers/device_words.h"
#include "devices/ports/seconds.h"
#include "pliant/math.h"

namespace pliant {

struct StickSettings {
  bool rate = true;         // false: by position
  double speed = 0.10;      // [m/s] at full deflection
  double turn = 1.5;        // [rad/s] at full deflection
  double dead_zone = 0.06;  // [1] deflection that counts as zero
  double reach = 0.05;      // [m] by position: at full deflection
  double angle = 0.6;       // [rad] by position: at full deflection
  dvec3 extent{0.10};       // [m] half of the workspace, which bounds the pose
  double smooth = 0.02;     // [s] time constant of the low-pass on the deflection, so that its steps are not felt
};

// Its options: control=rate|position, speed, turn, dead_zone, reach.
inline constexpr const char* kStickKeys[] = {"control", "speed", "turn", "dead_zone", "reach"};
Result<StickSettings> stick_settings(const std::string& driver, const DeviceWords& words, StickSettings defaults);

// `deflection` in [-1, 1] with the dead zone removed: continuous there, still 1 at 1, odd, never NaN.
double without_dead_zone(double deflection, double dead_zone);

class StickControl {
 public:
  StickControl() = default;
  explicit StickControl(const StickSettings& settings) : settings_(settings) {}

  // `move`, `turn`: deflections in [-1, 1] along and about world axes. `clutch`: freezes the pose, which continues from
  // there without a jump. `dt` [s] is limited to 0.1, so that a pause causes no jump.
  void step(const dvec3& move, const dvec3& turn, bool clutch, double dt);

  const dvec3& position() const { return position_; }
  const dquat& rotation() const { return rotation_; }

 private:
  StickSettings settings_;
  dvec3 move_{0}, turn_{0};  // low-passed
  dvec3 base_{0}, position_{0};
  dquat base_rotation_{1, 0, 0, 0}, rotation_{1, 0, 0, 0};
};

// The rotation by `vector` [rad].
dquat rotation_by(const dvec3& vector);

}  // namespace pliant
