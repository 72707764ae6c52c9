// The shipped profiles of simulated devices.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "pliant/driver.h"

namespace pliant {

struct DeviceProfile {
  const char* name;
  const char* title;
  double mass;                 // [kg] reflected at the effector
  double damping;              // [N s/m] physical
  double friction;             // [N] Coulomb's
  double encoder;              // [m] per count, at the effector
  double force_step;           // [N] per count of the amplifier
  double lag;                  // [s] time constant of the amplifier
  double delay;                // [s] transport delay from a write to the amplifier
  double rate;                 // [Hz]
  double max_force;            // [N] peak
  double continuous;           // [N]; 0: unspecified
  double stiffness;            // [N/m] largest stably rendered stiffness, from its vendor or CHAI3D's table
  double max_damping;          // [N s/m] the same for a rendered damper
  dvec3 workspace;             // [m] half of its extents
  double max_velocity;         // [m/s]; 0: unspecified
  const char* sources;         // which numbers are published, and which are assumed
  double max_torque = 0.0;     // [N m] peak; 0: it renders none, and its rotation is the hand's
  double inertia = 0.0;        // [kg m2] reflected at the grip; these values hold for each axis
  double turn_damping = 0.0;   // [N m s/rad] physical
  double turn_friction = 0.0;  // [N m] Coulomb's
  double turn_encoder = 0.0;   // [rad] per count
};

// Rubber end stops of a workspace, for a device of mass m of any make. Assumed.
inline constexpr double kStopStiffness = 2e4;     // [N/m]
inline constexpr double kStopDampingRatio = 0.3;  // [1] of critical damping

// [N s/m] Damping that the lightest touch of a fingertip adds to a device's own (Hajian and Howe 1997: 2 to 5).
inline constexpr double kLightHandDamping = 2.0;

inline constexpr std::size_t kDeviceProfiles = 8;
const std::array<DeviceProfile, kDeviceProfiles>& device_profiles();
const DeviceProfile* find_device_profile(std::string_view name);
std::string device_profile_names();  // "touch, omni, ..."

// The capabilities that its driver reports.
DeviceCapabilities capabilities_of(const DeviceProfile& profile);

}  // namespace pliant
