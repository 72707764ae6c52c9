// Level files as scenes: glTF with PLIANT extensions, Draco, and every mesh format that `pliant convert` reads.
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

// The most that a file may ask of a haptic device. What a program sets itself (set_key, Session::set, a scene in code)
// may go beyond.
struct SafetyCap {
  double max_force = 10.0;  // [N] of a hand's device; what its driver can render is a limit beside this one
  // [N/s] From nothing to max_force no faster than the usual device from nothing to its own: in 3.3 ms.
  // 1 N/s at least, which is the least that a device may have.
  double max_slew() const {
    return std::max(1.0, max_force * DeviceParameters().max_slew / DeviceParameters().max_force);
  }
  // [N m] Of a tool: max_force at the end of a lever of 10 cm.
  double max_torque() const { return 0.1 * max_force; }
};

// A bare mesh becomes a deformable surface. `notes` gets what was read differently than one might expect. The
// error names file and JSON pointer. Devices and tools get no more than `cap`; a note says where the file asked for it.
// `progress` is told, on this thread, and may end it with an Error.
Result<Scene> load_scene(const std::filesystem::path& file, std::vector<std::string>* notes = nullptr,
                         const SafetyCap& cap = {}, const OpenProgress& progress = {});
// .gltf (with a .bin beside it) or .glb by the extension; the file appears whole.
Status save_scene(const Scene& scene, const std::filesystem::path& file);
// NODE.EXTENSION.KEY=VALUE, say "tissue.deformable.stiffness=500", as `pliant run --set` has it (docs/cli.md).
Status set_key(Scene& scene, const std::string& assignment);

// Text of files (names in notes and errors) as it may stand on a terminal: controls, bidirectional ones too, and bytes
// that are no UTF-8 are written as escapes.
std::string printable(std::string_view text);

// What a file may ask for is limited, so that a small one cannot fill the machine (docs/cli.md, Limits); this
// multiplies the limits, by 1e-6 to 1000. Once, before anything is opened.
void set_limit_factor(double factor);

}  // namespace pliant
