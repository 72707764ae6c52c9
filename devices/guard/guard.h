// Safety of one device, as a state machine (pliant/device_state.h) stepped at the device's rate:
//
//   disconnected  --a sound sample-->  idle  --arm-->  armed  --small wanted force, or dead-man-->  active
//   active, armed  --no valid sample or model for 10 ms-->  armed, without force
//   active, armed  --100 ms of it, five times in a second, or a danger-->  tripped
//   tripped  --the user arms it-->  armed
//
// No waiting, allocation, locks or exceptions, and no knowledge of threads or the driver: the same input gives the same
// output. Order of the limits: finite -> state -> ramp -> clamp by norm (device, level, heat) -> resists only -> slew
// -> passivity. A parameter never raises a device's own limit.
//
// It cannot know whether the amplifier renders the commanded force. A force of the wrong sign is detected only by the
// motion: speed increases against the force (kRunaway), faster than a pushing hand could cause.
#pragma once

#include "devices/guard/passivity.h"
#include "pliant/device_state.h"
#include "pliant/driver.h"

namespace pliant {

// Tunables, each with its unit, usual value and effect.
inline constexpr double kModelHolds = 0.010;     // [s] the same for a model
inline constexpr double kLatchAfter = 0.100;     // [s] without either: the device trips
inline constexpr double kUsualForce = 3.3;       // [N] default if no limit is specified
inline constexpr double kGateTorque = 0.01;      // [N m] and this
inline constexpr double kSettleTime = 0.05;      // [s] of fresh samples before a device arms itself
inline constexpr double kFrozenAfter = 0.3;      // [s] of an identical pose under force, then the force fades out
inline constexpr double kFrozenFade = 0.2;       // [s] duration of the fade
inline constexpr double kFarOut = 2.0;           // [1] times the workspace's half diagonal: beyond it a pose is invalid
inline constexpr double kRunawayGain = 0.05;     // [m/s] increase of speed against the force within about kRunawayTime
inline constexpr double kRunawayTime = 0.010;    // [s]
inline constexpr double kRunawayShare = 0.25;    // [1] share of the force limit above which runaway is tested
inline constexpr double kMostGiven = 5e-3;       // [J] net energy delivered to the hand despite damping, at which the
                                                 // device trips
inline constexpr double kThermalTime = 20.0;     // [s] thermal time constant of a motor's winding; longer: longer peaks
                                                 // are allowed
inline constexpr double kWarmShare = 0.5;        // [1] of the force limit, for a warm device without a continuous limit
inline constexpr double kFadeTime = 0.5;         // [s] in which the force fades out at low battery
inline constexpr double kDefaultVelocity = 2.0;  // [m/s] if a device specifies no limit
inline constexpr double kVelocityTime = 1.6e-3;  // [s] time constant of the velocity filter: 100 Hz
inline constexpr double kGuardLever = 0.05;      // [m] lever arm that converts force slew to torque slew
inline constexpr unsigned kMostLosses = 5;       // within one second, then it trips

// Orders of the user or the servo for this step. `stop` has precedence.
struct GuardOrders {
  bool arm = false, disarm = false, stop = false;
  bool let_go = false;     // intentionally no force: a missing model is no fault
  bool suspended = false;  // the machine was suspended since the last step
  bool failed = false;     // the driver threw an exception
};

// The touch tick's wanted force: the newest model evaluated at the device's current pose.
struct GuardInput {
  bool known = false;                               // a model is available
  double age = 0.0;                                 // [s] its age
  DeviceWrench wrench;                              // before limits
  dvec3 weight{0};                                  // [N] DeviceModel::weight
  dvec3 velocity{0};                                // [m/s] DeviceModel::carried
  double stiffness = 0.0, turning_stiffness = 0.0;  // [N/m], [N m/rad] of the model along the wrench; 0: unknown
  double max_force = 0.0, max_torque = 0.0;
  bool easing = false;  // DeviceModel::easing
};

// [N/m] The largest stiffness that is passive for any hand at this damping, rate and latency (Colgate and Schenkel
// 1997, b > K T / 2 + |B|, with the latency added to the half period). Limited by the device's own value; 0: neither is
// known. `model_damping` [N s/m]: B.
double stable_stiffness(const DeviceCapabilities& can, double rate, double model_damping = 0.0);

class Guard {
 public:
  explicit Guard(const DeviceCapabilities& can = {}, const GuardParameters& parameters = {});

  // One period: first the sample (null: none new), then the force to render.
  void sense(const DeviceSample* sample, double now, const GuardOrders& orders);
  DeviceWrench release(const GuardInput& wanted, double now, const GuardOrders& orders);
  // End of the run: zero force from now on.
  void close(double now);

  DeviceState state() const { return report_.state; }
  // True once after a step that tripped or lost the device: its motors must be switched off.
  bool take_make_safe();
  bool fresh(double now) const;  // the newest sound pose is recent enough
  dvec3 position() const { return position_; }
  dquat rotation() const { return rotation_; }
  dvec3 velocity() const { return velocity_; }  // [m/s] filtered
  dvec3 spin() const { return spin_; }          // [rad/s] filtered
  const EnergyAccount& energy() const { return energy_; }
  const DeviceReport& report() const { return report_; }  // without statistics

 private:
  void to(DeviceState state, DeviceCause cause, double now);
  void lose(DeviceCause cause, double now);  // removes the force; repeated losses trip
  void trip(DeviceCause cause, double now);
  bool running() const { return state() == DeviceState::kArmed || state() == DeviceState::kActive; }
  bool sound(const DeviceSample& sample, double now);
  void take(const DeviceSample& sample, double at);
  void watch(double now);
  void follow_orders(const GuardOrders& orders, double now);
  void decide(const GuardInput& wanted, const GuardOrders& orders, double now);
  bool runs_away(const GuardInput& wanted, double dt);
  double risen_slowly(double before, double most, double dt) const;
  void credit(const GuardInput& wanted, double share, double most);
  void forfeit(double energy);
  double force_limit(const GuardInput& wanted) const;
  double torque_limit(const GuardInput& wanted) const;
  DeviceWrench limited(const GuardInput& wanted, double dt);
  void send_nothing();

  DeviceCapabilities can_;
  GuardParameters parameters_;
  DeviceReport report_;
  bool make_safe_ = false;

  // The newest sound pose.
  bool placed_ = false, moves_ = false;  // `moves_`: the velocity is valid
  dvec3 position_{0}, velocity_{0}, spin_{0};
  dquat rotation_{1, 0, 0, 0};
  std::uint32_t buttons_ = 0, warnings_ = 0;
  bool ready_ = true;
  double sensed_at_ = 0.0;                       // [s]
  double fresh_since_ = 0.0, changed_at_ = 0.0;  // [s]
  bool heard_ = false;                           // a sample arrived in this step
  dvec3 way_{0}, turn_{0};                       // [m], [rad] in this step
  dvec3 carried_{0};                             // [m] motion of the touched object since the last sample

  bool stepped_ = false;
  double now_ = 0.0, dt_ = 0.0;  // [s] time of the last sense(), and interval since the previous one
  double missing_since_ = 0.0;   // [s] last time the missing sample or model was present
  bool missing_ = false;
  double ramp_ = 0.0, fade_ = 1.0, heat_ = 0.0;  // [1]; heat: mean square of force over the continuous one's
  double share_ = 0.0;                           // [1] product of ramp and fade in the last period
  double most_ = 0.0, most_turn_ = 0.0;          // [N], [N m] limit of the last period; 0: no force allowed
  double slow_speed_ = 0.0;                      // [m/s] for runs_away: a low-passed speed
  std::array<double, kMostLosses> losses_{};     // [s] times of the last losses
  std::size_t loss_ = 0;
  EnergyAccount energy_;
  PassivityDamper push_, twist_;
  StoredInInput pushed_, twisted_;
  double credited_ = 0.0;  // [J] in this contact
  DeviceWrench last_;
  bool disarmed_ = false;  // by the user: it does not arm itself
};

}  // namespace pliant
