// What a reader has checked of a file, of a scene that was made in code (pliant/scene.h).
#pragma once

#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

// Arrays that fit each other, indices within them, and every key within its range (content/keys/extension_table.h);
// derives what follows from them, as a reader does. The error names mesh or node.
Status check_scene(Level& level);

// Whether a device may have these limits: a force that leaves for a hand is clamped by them.
Status check_device(const std::string& name, const DeviceParameters& device);

}  // namespace pliant
