// Level files as scenes: glTF with PLIANT extensions, Draco, and every mesh format that `pliant convert` reads.
// Component `content` of the package.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

// A bare mesh becomes a surface that gives way. `notes` gets what was read differently than one might expect. The
// error names file and JSON pointer.
Result<Scene> load_scene(const std::filesystem::path& file, std::vector<std::string>* notes = nullptr);
// .gltf (with a .bin beside it) or .glb by the extension; the file appears whole.
Status save_scene(const Scene& scene, const std::filesystem::path& file);
// NODE.EXTENSION.KEY=VALUE, say "tissue.deformable.stiffness=500", as `pliant run --set` has it (docs/cli.md).
Status set_key(Scene& scene, const std::string& assignment);

}  // namespace pliant
