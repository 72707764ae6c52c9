// The shipped device profiles: what a simulated device is like.
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
  double encoder;              // [m] a count at the effector
  double force_step;           // [N] a count of the amplifier
  double lag;                  // [s] time constant of the amplifier
  double delay;                // [s] from a write to the amplifier: transport
  double rate;                 // [Hz]
  double max_force;            // [N] peak
  double continuous;           // [N]; 0: not said
  double stiffness;            // [N/m] that its maker or CHAI3D's table gives as the most it renders stably
  double max_damping;          // [N s/m] the same of a rendered damper
  dvec3 workspace;             // [m] half of its extents
  double max_velocity;         // [m/s]; 0: not said
  const char* sources;         // which numbers are published, and which are assumed
  double max_torque = 0.0;     // [N m] peak; 0: it renders none, and its rotation is the hand's
  double inertia = 0.0;        // [kg m2] reflected at the grip, all of this about each axis
  double turn_damping = 0.0;   // [N m s/rad] physical
  double turn_friction = 0.0;  // [N m] Coulomb's
  double turn_encoder = 0.0;   // [rad] a count
};

// The end stops of a workspace, rubber: what a device of mass m has, whatever its make. Assumed.
inline constexpr double kStopStiffness = 2e4;     // [N/m]
inline constexpr double kStopDampingRatio = 0.3;  // [1] of what would be critical

// [N s/m] What the lightest touch of a fingertip adds to a device's own damping (Hajian and Howe 1997: 2 to 5).
inline constexpr double kLightHandDamping = 2.0;

inline constexpr std::size_t kDeviceProfiles = 8;
const std::array<DeviceProfile, kDeviceProfiles>& device_profiles();
const DeviceProfile* find_device_profile(std::string_view name);
std::string device_profile_names();  // "touch, omni, ..."

// What its driver says of it.
DeviceCapabilities capabilities_of(const DeviceProfile& profile);

}  // namespace pliant
