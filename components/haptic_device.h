// A device that moves a probe and may render force. Drivers (pliant/driver.h), paths and the mouse write its pose. The
// touch tick uses no other data of them. `scale` is for drivers: scripts are in metres, world.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/math.h"
#include "components/range.h"
#include "pliant/driver.h"
#include "pliant/parameters.h"
#include "runtime/store.h"

namespace pliant {

enum class DriverKind : std::uint8_t { kNull, kScript, kOrbit, kMouse, kExternal };

// Without a driver, only the level's limits apply.
inline constexpr DeviceCapabilities kNoDriver{.senses_rotation = true, .renders_torque = true};

// Unknown state means zero force.
enum class DeviceStatus : std::uint8_t { kLost, kReady };

// Rate: touch. Writer: read_devices (sensed), write_devices (sent). Keys of PLIANT_haptic_device.
struct HapticDevice : DeviceParameters {
  DriverKind driver = DriverKind::kNull;
  std::string file;  // of the script, relative to the level
  std::string id;    // external drivers: identifies the device

  // Capabilities of its driver. Written on connection and release, never by an edit: an edit cannot lift them.
  DeviceCapabilities can = kNoDriver;
  double workspace = 1.0;  // [1] world metres per metre of the driver's; 1 where poses are in world coordinates
  dvec3 origin{0};         // [m] world: where the origin of the driver's workspace lies

  Handle<Path> path;  // script, orbit
  DeviceStatus status = DeviceStatus::kReady;
  dvec3 position{0};  // [m] world, as last sensed
  dquat rotation{1, 0, 0, 0};
  double grip = 0.0;       // [1] 0 to 1, as last sensed
  bool grips = false;      // its grip is sensed
  double sensed_at = 0.0;  // [s] time of that pose; older than kStaleAfter: treated as lost
  dvec3 force_sent{0};     // [N] world, sent to the hand in this tick
  dvec3 torque_sent{0};    // [N m] world, the same; only tools produce torque
};

// Bounds of its parameters, in a file and in code.
struct DeviceRange {
  static constexpr Range kScale{0.0, 1e6, true};   // [1]
  static constexpr Range kMaxForce{0.0, 1e3};      // [N]
  static constexpr Range kMaxStiffness{0.0, 1e7};  // [N/m]
  static constexpr Range kMaxSlew{1.0, 1e7};       // [N/s] below it no contact could be felt
};

}  // namespace pliant
