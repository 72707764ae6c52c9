// A device that moves a probe and may push back. Drivers (pliant/driver.h), paths and the mouse write its pose; this is
// all that the touch tick knows of them. `scale` is for drivers: scripts are in metres, world.
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

// Where no driver has said anything, nothing is limited but by the level.
inline constexpr DeviceCapabilities kNoDriver{.senses_rotation = true, .renders_torque = true};

// Unknown state means zero force.
enum class DeviceStatus : std::uint8_t { kLost, kReady };

// Rate: touch. Writer: read_devices (what was sensed), write_devices (what was sent). Keys of PLIANT_haptic_device.
struct HapticDevice : DeviceParameters {
  DriverKind driver = DriverKind::kNull;
  std::string file;  // of the script, relative to the level
  std::string id;    // external drivers: which one

  // Its driver's. Written where one is connected or released and never by an edit, so that none can lift them.
  DeviceCapabilities can = kNoDriver;
  double workspace = 1.0;  // [1] world metres per metre of the driver's; 1 where poses are in world coordinates
  dvec3 origin{0};         // [m] world: where the origin of the driver's workspace lies

  Handle<Path> path;  // script, orbit
  DeviceStatus status = DeviceStatus::kReady;
  dvec3 position{0};  // [m] world, as last sensed
  dquat rotation{1, 0, 0, 0};
  double sensed_at = 0.0;  // [s] when; older than kStaleAfter: treated as lost
  dvec3 force_sent{0};     // [N] world, what left for the hand in this tick
  dvec3 torque_sent{0};    // [N m] world, the same; only tools make any
};

// What its numbers may be, in a file and in code.
struct DeviceRange {
  static constexpr Range kScale{0.0, 1e6, true};   // [1]
  static constexpr Range kMaxForce{0.0, 1e3};      // [N]
  static constexpr Range kMaxStiffness{0.0, 1e7};  // [N/m]
  static constexpr Range kMaxSlew{1.0, 1e7};       // [N/s] slower, and no contact could be felt
};

}  // namespace pliant
