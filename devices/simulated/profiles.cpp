#include "devices/simulated/profiles.h"

namespace pliant {

// Peak force, stable stiffness and stable damping are from CHAI3D's device table; Omni's mass, friction, resolution and
// continuous force from its vendor's data sheet. Unpublished values (reflected mass, damping and friction of the delta
// mechanisms, amplifiers, transport) are assumptions of the right order of magnitude. They describe a class of devices,
// not an individual one.
const std::array<DeviceProfile, kDeviceProfiles>& device_profiles() {
  static const std::array<DeviceProfile, kDeviceProfiles> all{{
      // name, title, mass, damping, friction, encoder, force step, lag, delay, rate, peak, continuous, K, B, workspace,
      // velocity
      {"touch",
       "3D Systems Touch",
       0.045,
       0.10,
       0.26,
       55e-6,
       2e-3,
       0.3e-3,
       1e-3,
       1000,
       3.3,
       0.88,
       400,
       4,
       {0.08, 0.06, 0.035},
       0,
       "mass, friction, encoder, forces, workspace: maker's sheet; K, B: CHAI3D; damping, lag, delay: assumed"},
      {"omni",
       "SensAble Phantom Omni",
       0.045,
       0.10,
       0.26,
       55e-6,
       2e-3,
       0.3e-3,
       1e-3,
       1000,
       3.3,
       0.88,
       700,
       5,
       {0.08, 0.06, 0.035},
       0,
       "mass, friction, encoder, forces, workspace: maker's sheet; K, B: CHAI3D; damping, lag, delay: assumed"},
      {"falcon",
       "Novint Falcon",
       0.25,
       1.0,
       0.30,
       60e-6,
       5e-3,
       0.3e-3,
       1e-3,
       1000,
       8.0,
       0,
       3000,
       20,
       {0.05, 0.05, 0.05},
       0,
       "encoder (400 dpi), workspace, force: maker; K, B: CHAI3D; mass, damping, friction, lag, delay: assumed"},
      {"omega.7",
       "Force Dimension omega.7",
       0.22,
       1.0,
       0.20,
       10e-6,
       1e-3,
       0.2e-3,
       0.25e-3,
       4000,
       12.0,
       0,
       5000,
       30,
       {0.08, 0.08, 0.055},
       0,
       "encoder, workspace, force, rate: maker; K, B: CHAI3D; mass, damping, friction, lag, delay: assumed"},
      {"sigma.7",
       "Force Dimension sigma.7",
       0.30,
       1.5,
       0.30,
       2e-6,
       1e-3,
       0.2e-3,
       0.25e-3,
       4000,
       12.0,
       0,
       4000,
       30,
       {0.095, 0.095, 0.065},
       0,
       "encoder, workspace, rate, torque: maker; force, K, B: CHAI3D; mass, damping, friction, lag, delay and all else "
       "of "
       "its turns: assumed",
       0.2,
       5e-4,
       2e-3,
       5e-3,
       2.3e-4},
      {"delta.3",
       "Force Dimension delta.3",
       0.40,
       2.0,
       0.40,
       20e-6,
       1e-3,
       0.2e-3,
       0.25e-3,
       4000,
       20.0,
       0,
       5000,
       30,
       {0.2, 0.2, 0.13},
       0,
       "encoder, workspace, force, rate: maker; K, B: CHAI3D; mass, damping, friction, lag, delay: assumed"},
      {"polhem",
       "Haptikfabriken Polhem",
       0.15,
       0.5,
       0.15,
       20e-6,
       3e-3,
       0.3e-3,
       1e-3,
       1000,
       5.0,
       0,
       2000,
       10,
       {0.1, 0.1, 0.08},
       0,
       "force and K: its open API's table; encoder from 4096 counts a turn and its capstan; all others assumed"},
      {"inverse3",
       "Haply Inverse3",
       0.20,
       0.5,
       0.10,
       10e-6,
       5e-3,
       0.3e-3,
       1e-3,
       1000,
       10.0,
       0,
       2000,
       10,
       {0.2, 0.15, 0.15},
       0,
       "peak force: maker; all others assumed"},
  }};
  return all;
}

const DeviceProfile* find_device_profile(std::string_view name) {
  for (const DeviceProfile& profile : device_profiles())
    if (name == profile.name) return &profile;
  return nullptr;
}

std::string device_profile_names() {
  std::string names;
  for (const DeviceProfile& profile : device_profiles())
    names += (names.empty() ? "" : ", ") + std::string(profile.name);
  return names;
}

DeviceCapabilities capabilities_of(const DeviceProfile& profile) {
  DeviceCapabilities can;
  can.simulated = true;
  can.senses_rotation = true;
  can.renders_torque = profile.max_torque > 0.0;
  can.max_torque = profile.max_torque;
  can.max_force = profile.max_force;
  can.max_stiffness = profile.stiffness;
  can.continuous_force = profile.continuous;
  can.max_velocity = profile.max_velocity;
  can.workspace = profile.workspace;
  can.damping = profile.damping + kLightHandDamping;
  can.rate = profile.rate;
  can.latency = profile.delay + profile.lag + 1.0 / profile.rate;
  return can;
}

}  // namespace pliant
