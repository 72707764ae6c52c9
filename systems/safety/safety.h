// Safety layer of the force sent to a hand: finite, clamped, slew-limited, passive; zero while any input is unknown.
// Order: finite -> status -> engage gate -> norm clamp -> passivity -> stiffness limit -> slew. The output is written
// to the device unchanged, so the work account is that of the hand. Any reduction of the wanted force while the pose is
// known is counted (SafetyTally), so that a run can report it.
//
// Passivity (methods.md 1.9). An observer adds up the work on the hand over the whole history, trapezoidal. The force
// may give back what it took, and kPassivityShare of the most that the hand had stored beside. What would go beyond is
// taken out by damping: only the component along the motion is reduced, and early enough that the slew limit suffices.
// Setting the force to zero instead lost: in the middle of a contact that is a jump, and the hand feels a hole.
// A spent account (a surface that stiffens under a hand, a gate that opened in contact) limits the force to that of a
// spring, kSpentSpring as stiff as the touched surface, which stores the remaining energy. The force returns as the
// spring is pressed. Damping alone switched the force with the sign of the last step while the hand rested.
//
// A tool without weight compensation hangs in the hand: on reconnection of a device, the wanted force is never small.
// Its weight is known beforehand, so the gate opens on the wanted force without the weight. The weight then fades in
// from zero over kWeightTime. The observer excludes the weight's work: lowering may return the energy of lifting. If
// something else supports the weight while the tool is lifted, the observer is above zero, and lowering is damped until
// it is not.
//
// A device that is farther from its last position than a hand can move in that time did not move there: tracking was
// lost, or the device was relocated. No work is counted for that displacement, the force goes to zero within the slew
// limit, and the gate must be passed again.
//
// The slew limit applies to rising force. Force that is no longer wanted falls at least at kLeastFall: a low limit must
// neither hold the hand back nor delay a lowered max_force.
//
// A tick that comes late has not had the time of those that it missed: its force may rise by one tick's slew, and after
// kEasedFrom what rose meanwhile comes in over kEase (of a tool, kToolEase), from what the device still has: the force
// that left last, and after kForceHolds none. What is let go has had the time: it falls by as much as in the ticks that
// were missed.
//
// A surface whose stiffness rises in time (components/varying.h) may push a hand with what it gains: that goes to the
// hand's account, as if the hand had given it. The loss of a falling stiffness is forfeit.
//
// A surface with prescribed motion may push a hand, as a motor would: passivity and the stiffness limit apply to the
// hand's motion relative to that surface. Clamp and slew bound the rest.
#pragma once

#include <array>
#include <cstddef>

#include "components/hand_limits.h"
#include "components/haptic_device.h"

namespace pliant {

// Tunables of the safety layer. Unit, usual value, and what changing it does.
inline constexpr double kWeightTime = 0.5;        // [s] in which a weight fades in, once the gate is open
inline constexpr double kPassivityFloor = 1e-12;  // [J] what rounding may add
inline constexpr double kCountedShare = 0.01;     // [1] of the wanted force: less missing is not counted
inline constexpr double kCountedForce = 1e-3;     // [N] less missing is not counted

inline constexpr double kLeastFall = 1000.0;  // [N/s] least rate at which force that is no longer wanted falls

inline constexpr double kEasedFrom = 0.0105;  // [s] without a tick, then what rose meanwhile comes in slowly,
inline constexpr double kForceHolds = 0.020;  // [s] that devices and their drivers' threads go on with a force
inline constexpr double kToolEase = 0.06;     // [s] of a tool: until the soft clock has seen where it went
inline constexpr double kEase = 0.015;        // [s] in this time

inline constexpr double kRaise = 0.2;  // [s] in which a limit that is raised comes in

// A valid rotation: finite and of about unit length.
bool plausible_rotation(dquat rotation);

// A valid position: finite and not absurdly far away.
bool plausible_position(dvec3 position);

// Reasons for a difference between the sent and the wanted force.
enum class SafetyLimit : std::uint8_t {
  kClipped,   // wanted more than the device's largest force
  kWithheld,  // reduced by damping, because the hand would have got more energy than it gave
  kGated,     // the gate is closed until the wanted force has been small
  kSlewed     // the wanted force changed faster than the slew or stiffness limit allows
};
inline constexpr std::size_t kSafetyLimits = 4;

// Number of ticks in which a limit acted, and its largest reduction as a share of the wanted force [1].
struct LimitCount {
  std::uint64_t ticks = 0;
  double largest_share = 0.0;
};

// Since the start. All clipped ticks count; the others only above both kCountedShare and kCountedForce.
struct SafetyTally {
  std::array<LimitCount, kSafetyLimits> counts;
  std::uint8_t now = 0;  // the last tick's, as bits: 1 << SafetyLimit

  const LimitCount& of(SafetyLimit limit) const { return counts[static_cast<std::size_t>(limit)]; }
  void add(SafetyLimit limit, double share);
};
constexpr std::uint8_t bit(SafetyLimit limit) {
  return static_cast<std::uint8_t>(1u << static_cast<unsigned>(limit));
}

struct SafetyState {
  double share = 1.0;        // [1] share of the force that is sent: stiffness limit (systems/device/softening.h)
  double least_share = 1.0;  // [1] its minimum so far
  bool felt = true;          // false: the guard behind blocked the force after this tick (engine/run/driver_link.h)
  bool engaged = false;      // gate: closed at start and after every loss, opens on a small computed force
  double hidden = 0.0;       // [1] share of the weight that has not faded in yet
  dvec3 weight{0};           // [N] last tick's, as felt
  bool placed = false;       // `position` is valid
  double sensed_at = 0.0;    // [s] of the last tick's pose
  dvec3 position{0};         // [m] last tick's, in the hand's metres
  dvec3 force{0};            // [N] last tick's, as sent
  dvec3 added{0};            // [N] world: the program's own, wanted beside what is touched
  double added_share = 0.0;  // [1] of it that may have come in, once the gate is open
  dvec3 own{0};              // [N] as much of it as is wanted now
  dvec3 wanted{0};           // [N] last tick's beside the weight, clamped to the device's limit
  double most = 0.0;         // [N] last tick's limit; 0: there was none
  double kept_back = 0.0;    // [N] of it, while the account is spent
  double touched = 0.0;      // [N/m] last tick's SafetyLimits::touched
  double work = 0.0;         // [J] done on the hand so far beside the weight: sum of (f0 + f1)/2 . dx
  double stored = 0.0;       // [J] the largest that -work has been
  bool ticked = false;       // `ticked_at` means something
  double ticked_at = 0.0;    // [s] the last tick
  double eased = 1.0;        // [1] share of the wanted force allowed since missed ticks
  double easing = 0.0;       // [1/s] its rate of growth
  SafetyTally tally;
};

enum class SafetyEvent : std::uint8_t { kNone, kNonFinite, kStale, kJumped };

struct SafetyResult {
  dvec3 force{0};  // [N] to send
  SafetyEvent event = SafetyEvent::kNone;
};

// Limits of the layer. For torques the same, in [N m], [N m/rad], [N m/s] and [rad/s]. Stiffness, speeds and work are
// in the hand's units: if a driver's workspace is scaled to the world, a metre of the hand is `scale` metres of the
// world.
struct SafetyLimits {
  double force = 0.0;             // [N]
  double stiffness = 0.0;         // [N/m] of the hand's metres; 0: none
  double slew = 0.0;              // [N/s]
  dvec3 weight{0};                // [N] part of the wanted force: weight of a tool without compensation
  double slow = kSlowHand;        // [m/s]
  dvec3 carried{0};               // [m] world; displacement of the touched surface in this tick
  double fastest = kFastestHand;  // [m/s]
  bool jumped = false;            // the device is elsewhere, regardless of `position`
  double fall = kLeastFall;       // [N/s] rate of fall of force that is no longer wanted, if `slew` is lower
  double scale = 1.0;             // [1] world metres per metre of the hand
  double stiffened = 0.0;         // [J] of the hand: what is touched has gained as its stiffness changed, by no hand
  double own_rise = 0.0;          // [N] change of the program's own part in this tick: no answer to displacement
  double ease = kEase;            // [s] in which it comes back after a stall
  double touched = 0.0;           // [N/m] per metre of the hand: slope and secant of the law at most; 0: unknown
  double spring = kUsualSpring;   // [N/m] of a spent account where `touched` is not known
};

// `pressed` [N] plus the program's part (SafetyState::added). The gate depends on the contact force only. While it is
// closed the part is zero; afterwards it fades in over kWeightTime. Changes obey the slew limit. The safety layer
// treats it like any other force.
dvec3 with_own(SafetyState& state, SafetyLimits& limits, dvec3 pressed, double dt);

// The smaller of the level's and the driver's limits. 0 for components that are not rendered.
SafetyLimits force_limits(const HapticDevice& device);
SafetyLimits torque_limits(const HapticDevice& device, const HandleParameters& handle);
// Of a probe, which has no handle: its largest force at kProbeLever.
inline constexpr double kProbeLever = 0.1;  // [m]
SafetyLimits probe_torque_limits(const HapticDevice& device);

// Whether the device reached `position` faster than a hand can. For a device sampled more slowly than the touch clock,
// the time since its last sample counts.
bool jumps(const SafetyState& state, const HapticDevice& device, const SafetyLimits& limits, dvec3 position, double dt);

// `wanted` [N] world, `position` [m] world, now [s], dt [s]. Without limits: the device's for forces.
SafetyResult make_safe(SafetyState& state, const HapticDevice& device, const SafetyLimits& limits, dvec3 wanted,
                       dvec3 position, double now, double dt);
SafetyResult make_safe(SafetyState& state, const HapticDevice& device, dvec3 wanted, dvec3 position, double now,
                       double dt);

}  // namespace pliant
