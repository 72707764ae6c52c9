// Safety of one device, as a state machine (pliant/device_state.h) that is stepped at the device's rate:
//
//   disconnected  --a sound sample-->  idle  --arm-->  armed  --small wanted force, or dead-man-->  active
//   active, armed  --no sample or model, or one that means nothing, for 10 ms-->  armed, without force
//   active, armed  --100 ms of it, five times in a second, or a danger-->  tripped
//   tripped  --a person arms it-->  armed
//
// Nothing here waits, allocates, locks or throws, and nothing knows of threads or of a driver: the same input gives the
// same output. Order of what may leave: finite -> state -> ramp -> clamp by norm (device, level, heat) -> resists only
// -> slew -> passivity. What a device says of itself is never raised by a parameter.
//
// What it cannot know: whether the amplifier does what it is told. A force with the wrong sign shows only in what the
// hand does: it gathers speed against the force (kRunaway), faster than a hand that pushes.
#pragma once

#include "devices/guard/passivity.h"
#include "pliant/device_state.h"
#include "pliant/driver.h"

namespace pliant {

// Tunables. Unit, usual value, and what changing it does.
inline constexpr double kSampleHolds = 0.010;    // [s] a pose older than this is none; of slow devices 2.5 periods
inline constexpr double kModelHolds = 0.010;     // [s] the same of a model
inline constexpr double kLatchAfter = 0.100;     // [s] of either: the device trips
inline constexpr double kUsualForce = 3.3;       // [N] where nobody says a largest one
inline constexpr double kGateForce = 0.2;        // [N] the gate opens below this
inline constexpr double kGateTorque = 0.01;      // [N m] and this
inline constexpr double kSettleTime = 0.05;      // [s] of fresh samples before a device arms itself
inline constexpr double kFrozenAfter = 0.3;      // [s] of the very same pose under force, then it fades
inline constexpr double kFrozenFade = 0.2;       // [s] within which it is gone
inline constexpr double kFarOut = 2.0;           // [1] times the workspace's half diagonal: not a pose of this device
inline constexpr double kFastestSample = 20.0;   // [m/s] what is faster is a jump
inline constexpr double kRunawayGain = 0.05;     // [m/s] of speed against the force, gathered in about kRunawayTime
inline constexpr double kRunawayTime = 0.010;    // [s]
inline constexpr double kRunawayShare = 0.25;    // [1] of the largest force, above which that is looked at
inline constexpr double kMostGiven = 5e-3;       // [J] that the hand got beyond what it gave, in spite of the damping
inline constexpr double kThermalTime = 20.0;     // [s] of a motor's winding; longer: peaks are allowed for longer
inline constexpr double kWarmShare = 0.5;        // [1] of the largest force, where a warm device says no continuous one
inline constexpr double kFadeTime = 0.5;         // [s] in which a low battery takes the force away
inline constexpr double kDefaultVelocity = 2.0;  // [m/s] where a device says no largest one
inline constexpr double kVelocityTime = 1.6e-3;  // [s] of the filter of velocities: 100 Hz
inline constexpr double kGuardLever = 0.05;      // [m] a torque's slew is a force's at this lever
inline constexpr unsigned kMostLosses = 5;       // in one second, then it trips

// What a person or the servo wants of it at this step. `stop` wins over all.
struct GuardOrders {
  bool arm = false, disarm = false, stop = false;
  bool let_go = false;     // nothing is wanted, on purpose: no model is missed
  bool suspended = false;  // the machine slept since the last step
  bool failed = false;     // the driver threw
};

// What the touch tick wants, as the newest model has it at the device's pose now.
struct GuardWish {
  bool known = false;                               // there is a model
  double age = 0.0;                                 // [s] of it
  DeviceWrench wrench;                              // not limited
  dvec3 weight{0};                                  // [N] DeviceModel::weight
  dvec3 velocity{0};                                // [m/s] DeviceModel::carried
  double stiffness = 0.0, turning_stiffness = 0.0;  // [N/m], [N m/rad] of it, along it; 0: not known
  double max_force = 0.0, max_torque = 0.0;
};

// [N/m] the largest stiffness that is passive with this damping at this rate and latency, whoever holds it (Colgate and
// Schenkel 1997, b > K T / 2 + |B|, the latency added to the half period's hold), or that the device says, if less; 0:
// neither says one. `model_damping` [N s/m]: B.
double stable_stiffness(const DeviceCapabilities& can, double rate, double model_damping = 0.0);

class Guard {
 public:
  explicit Guard(const DeviceCapabilities& can = {}, const GuardParameters& parameters = {});

  // One period: first what was sensed (null: nothing new), then what may leave.
  void sense(const DeviceSample* sample, double now, const GuardOrders& orders);
  DeviceWrench release(const GuardWish& wish, double now, const GuardOrders& orders);
  // It has come to its end; from now on nothing leaves.
  void close(double now);

  DeviceState state() const { return report_.state; }
  // True once after a step that tripped the device or lost it: its motors are to be switched off.
  bool take_make_safe();
  bool fresh(double now) const;  // the newest sound pose may be believed
  dvec3 position() const { return position_; }
  dquat rotation() const { return rotation_; }
  dvec3 velocity() const { return velocity_; }  // [m/s] filtered
  dvec3 spin() const { return spin_; }          // [rad/s] filtered
  const EnergyAccount& energy() const { return energy_; }
  const DeviceReport& report() const { return report_; }  // without figures

 private:
  void to(DeviceState state, DeviceCause cause, double now);
  void lose(DeviceCause cause, double now);  // without force; what repeats trips
  void trip(DeviceCause cause, double now);
  bool running() const { return state() == DeviceState::kArmed || state() == DeviceState::kActive; }
  bool sound(const DeviceSample& sample, double now);
  void take(const DeviceSample& sample, double at);
  void watch(double now);
  void follow_orders(const GuardOrders& orders, double now);
  void decide(const GuardWish& wish, const GuardOrders& orders, double now);
  bool runs_away(const GuardWish& wish, double dt);
  double risen_slowly(double before, double most, double dt) const;
  void credit(const GuardWish& wish, double share, double most);
  double force_limit(const GuardWish& wish) const;
  double torque_limit(const GuardWish& wish) const;
  DeviceWrench limited(const GuardWish& wish, double dt);
  void send_nothing();

  DeviceCapabilities can_;
  GuardParameters parameters_;
  DeviceReport report_;
  bool make_safe_ = false;

  // The newest sound pose.
  bool placed_ = false, moves_ = false;  // `moves_`: the velocity means something
  dvec3 position_{0}, velocity_{0}, spin_{0};
  dquat rotation_{1, 0, 0, 0};
  std::uint32_t buttons_ = 0, warnings_ = 0;
  bool ready_ = true;
  double sensed_at_ = 0.0;                       // [s]
  double fresh_since_ = 0.0, changed_at_ = 0.0;  // [s]
  bool heard_ = false;                           // in this step
  dvec3 way_{0}, turn_{0};                       // [m], [rad] in this step
  dvec3 carried_{0};                             // [m] what is touched, since the last sample

  bool stepped_ = false;
  double now_ = 0.0, dt_ = 0.0;  // [s] of the last sense(), and since the one before
  double missing_since_ = 0.0;   // [s] the sample or model that is missing was there
  bool missing_ = false;
  double ramp_ = 0.0, fade_ = 1.0, heat_ = 0.0;  // [1]; heat: mean square of force over the continuous one's
  double share_ = 0.0;                           // [1] ramp and fade of the last period
  double most_ = 0.0, most_turn_ = 0.0;          // [N], [N m] that might leave in the last period; 0: nothing might
  double slow_speed_ = 0.0;                      // [m/s] of runs_away: the speed a moment ago
  std::array<double, kMostLosses> losses_{};     // [s] the last times
  std::size_t loss_ = 0;
  EnergyAccount energy_;
  PassivityDamper push_, twist_;
  StoredInWish pushed_, twisted_;
  DeviceWrench last_;
  bool disarmed_ = false;  // by a person: it does not arm itself
};

}  // namespace pliant
