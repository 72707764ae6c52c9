// The arm of WoodenHaptics (Forsslund, Yip, Sallnäs 2015) and Polhem v1: a body A that turns about the vertical, an
// upper arm B, and a forearm C that a parallel linkage drives, so that both angles are counted from the vertical.
//
// Legend, device axes (x towards the user, y right, z up):
//   a [rad]  of body A about z          la [m] height of B's axis
//   b [rad]  of B, 0 upright            lb [m] its length
//   c [rad]  of C, 0 hanging            lc [m] its length
//   r = lb sin b + lc sin c             reach from the vertical axis
//   p = (r cos a, r sin a, la + lb cos b - lc cos c) - origin
// World axes (right, up, towards the user): (y, z, x).
//
// Motors: each pulls its body by a capstan; encoders sit on the motors. Body angle = sign * counts / cpr * 2 pi *
// capstan / body diameter. tau = J^T F on the bodies, and on a motor that times sign * capstan / body diameter.
#pragma once

#include <array>
#include <cstdint>

#include "pliant/math.h"

namespace pliant {

// A build of the arm, with its vendor's published constants. Polhem v2 and v3 have another linkage with unpublished
// geometry; they are not supported.
struct PolhemConfig {
  const char* name;
  dvec3 capstan;            // [m] diameters, of A, B, C
  dvec3 body;               // [m] the same
  double la, lb, lc;        // [m]
  dvec3 origin;             // [m] of the workspace, device axes
  double radius;            // [m] of the workspace
  dvec3 torque_constant;    // [N m/A]
  dvec3 counts;             // encoder counts per turn of the motor
  dvec3 turn_counts;        // the same for the gimbal's encoders; 0: none
  double max_force;         // [N]
  double max_stiffness;     // [N/m]
  double max_current;       // [A] per motor
  std::array<int, 6> home;  // counts of all encoders in the parked pose for calibration
  dvec3 sign;               // +1 or -1: sign of the motor's rotation for an increasing body angle
  dvec3 turn_sign;          // the same for the gimbal's encoders
};

// polhem_v1, woodenhaptics_v2015, aluhaptics_v2, vintage.
extern const std::array<PolhemConfig, 4> kPolhemConfigs;

struct PolhemPose {
  dvec3 position{0};           // [m] world
  dquat rotation{1, 0, 0, 0};  // device to world
};

// Angles of the bodies [rad].
dvec3 polhem_angles(const PolhemConfig& config, const std::array<std::int16_t, 6>& counts);
// Position of the tip, world axes [m].
dvec3 polhem_position(const PolhemConfig& config, const dvec3& angles);
// World velocity = J * angle rates. Columns: by a, by b, by c.
dmat3 polhem_jacobian(const PolhemConfig& config, const dvec3& angles);
PolhemPose polhem_pose(const PolhemConfig& config, const std::array<std::int16_t, 6>& counts);

// Motor currents [A] that render `force` (world, on the hand). If one exceeds the limit, all are scaled, which keeps
// the direction. Zero if the force is not finite.
dvec3 polhem_currents(const PolhemConfig& config, const dvec3& angles, const dvec3& force);
// The force rendered by currents: the inverse of the above. For tests and emulation.
dvec3 polhem_force(const PolhemConfig& config, const dvec3& angles, const dvec3& currents);

}  // namespace pliant
