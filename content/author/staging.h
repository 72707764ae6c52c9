// A light, a camera and a material for an object.
#pragma once

#include "content/author/object_frame.h"

namespace pliant {

// Adds a directional light before the node. It lights the object (kNoLevelNode: everything) from the upper right.
// Returns the number of the new node.
std::int32_t add_light(Level& level, std::int32_t object);
// Adds a camera that sees the whole object, from slightly above and in front (+Z). Returns the number of the new node.
std::int32_t add_camera(Level& level, std::int32_t object);
// Of one colour. Returns the material's index.
std::int32_t add_material(Level& level, const std::string& name, vec3 color, float roughness);

}  // namespace pliant
