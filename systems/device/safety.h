// What may leave for a hand: finite, clamped, slew-limited, passive force, and nothing at all while anything is
// unknown. Order: finite -> status -> engage gate -> norm clamp -> stiffness limit -> slew -> passivity.
//
// A tool that nothing carries hangs in the hand: what is wanted of a device that comes back to it is never small. As
// its weight is known beforehand, the gate also opens on what is wanted beside it; then the weight comes in from zero
// over kWeightTime. Passivity books what is done beside it: lowered, it may give what lifting it took. Where something
// else bears it while it is lifted, the books stand above zero, and no force goes along with the hand until they do
// not.
#pragma once

#include "components/haptic_device.h"

namespace pliant {

// Tunables of the safety layer. Unit, usual value, and what changing it does.
inline constexpr double kEngageForce = 0.2;        // [N] the gate opens once the computed force has been below this
inline constexpr double kWeightTime = 0.5;         // [s] in which a weight comes into the hand, once the gate is open
inline constexpr double kStaleAfter = 0.010;       // [s] a pose older than this counts as lost
inline constexpr double kPassivityReserve = 1.05;  // [1] the next step is assumed this much longer than the last

inline constexpr double kFarthest = 1e6;  // [m] a pose farther from the origin is a device's error

// Finite and not absurdly far away: a position that means something.
bool plausible_position(dvec3 position);

struct SafetyState {
  bool engaged = false;  // gate: closed at start and after every loss, opens on a small computed force
  double hidden = 0.0;   // [1] share of the weight that is not felt yet
  dvec3 weight{0};       // [N] last tick's, as felt
  bool placed = false;   // `position` means something
  dvec3 position{0};     // [m] last tick's
  dvec3 force{0};        // [N] last tick's, as sent
  double work = 0.0;     // [J] done on the hand so far beside the weight: sum of (f0 + f1)/2 . dx; kept <= 0 without
};

enum class SafetyEvent : std::uint8_t { kNone, kNonFinite, kStale };

struct SafetyResult {
  dvec3 force{0};  // [N] to send
  SafetyEvent event = SafetyEvent::kNone;
};

// What the layer holds to. A torque has the same, in [N m], [N m/rad] and [N m/s].
struct SafetyLimits {
  double force = 0.0;      // [N]
  double stiffness = 0.0;  // [N/m] 0: none
  double slew = 0.0;       // [N/s]
  dvec3 weight{0};         // [N] part of what is wanted: of a tool that nothing carries
};

// `wanted` [N] world, `position` [m] world, now [s], dt [s]. Without limits: the device's for forces.
SafetyResult make_safe(SafetyState& state, const HapticDevice& device, const SafetyLimits& limits, dvec3 wanted,
                       dvec3 position, double now, double dt);
SafetyResult make_safe(SafetyState& state, const HapticDevice& device, dvec3 wanted, dvec3 position, double now,
                       double dt);

}  // namespace pliant
