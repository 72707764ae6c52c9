// Loads level files as scenes: glTF with PLIANT extensions, Draco, and every mesh format that `pliant convert` reads.
// Component `content` of the package.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/progress.h"
#include "pliant/scene.h"

namespace pliant {

// Limits on the forces that a file may request from a haptic device. They do not apply to values that a program sets
// (set_key, Session::set, a scene built in code).
struct SafetyCap {
  double max_force = 10.0;  // [N] of a device; the driver's own limit applies too
  // [N/s] Slew limit: reaches max_force no faster than the default device reaches its own, in 3.3 ms. At least 1 N/s,
  // the smallest value that a device may have.
  double max_slew() const {
    return std::max(1.0, max_force * DeviceParameters().max_slew / DeviceParameters().max_force);
  }
  // [N m] Of a tool: max_force on a lever arm of 10 cm.
  double max_torque() const { return 0.1 * max_force; }
};

// A bare mesh becomes a deformable surface. `notes` receives unexpected conversions. The error names file and JSON
// pointer. `cap` limits devices and tools; a note reports where it lowered a value. `progress` is called on this thread
// and may cancel with an Error.
Result<Scene> load_scene(const std::filesystem::path& file, std::vector<std::string>* notes = nullptr,
                         const SafetyCap& cap = {}, const OpenProgress& progress = {});
// Writes .gltf (with a .bin beside it) or .glb by the extension, atomically.
Status save_scene(const Scene& scene, const std::filesystem::path& file);
// NODE.EXTENSION.KEY=VALUE, e.g. "tissue.deformable.stiffness=500", as in `pliant run --set` (docs/cli.md).
Status set_key(Scene& scene, const std::string& assignment);

// Text from files (names in notes and errors), made safe for a terminal: control characters, bidirectional ones too,
// and bytes that are not UTF-8 are escaped.
std::string printable(std::string_view text);

// Multiplies the limits on files (docs/cli.md, Limits) by 1e-6 to 1000. The limits keep a small file from exhausting
// the memory. Call once, before opening anything.
void set_limit_factor(double factor);

}  // namespace pliant
