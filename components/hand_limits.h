// What holds for every force that leaves for a hand, where a tick makes it (systems/safety) and where a device's servo
// renders it (devices/guard).
#pragma once

namespace pliant {

inline constexpr double kEngageForce = 0.2;   // [N] the gate opens once the computed force has been below this
inline constexpr double kStaleAfter = 0.010;  // [s] a pose older than this counts as lost; of slow devices 2.5 periods

inline constexpr double kFastestHand = 20.0;   // [m/s] a faster motion is a jump, not a hand's
inline constexpr double kFastestTurn = 200.0;  // [rad/s] the same for rotation
inline constexpr double kFarthest = 1e6;       // [m] a pose farther from the origin is a device's error
inline constexpr double kUnitWithin = 0.01;    // [1] of a rotation's length from 1: within it, it is normalised

// The passivity controller (methods.md 1.9).
inline constexpr double kPassivityReserve = 1.05;  // [1] the next step is assumed this much longer than the last
inline constexpr double kPassivityShare = 1e-3;    // [1] of the largest stored energy, which the hand may get beside
inline constexpr double kSpentSpring = 1.5;        // [1] of the touched stiffness: the spring of a spent account
inline constexpr double kUsualSpring = 2000.0;     // [N/m] where that stiffness is unknown; softer: earlier release
inline constexpr double kUsualTurnSpring = 5.0;    // [N m/rad] the same for rotation, at a lever arm of 50 mm
inline constexpr double kSlowHand = 0.01;          // [m/s] below it, damping is proportional to the speed
inline constexpr double kSlowTurn = 0.2;           // [rad/s] the same for rotation

}  // namespace pliant
