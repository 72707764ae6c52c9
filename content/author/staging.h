// A light and a camera for an object.
#pragma once

#include "content/author/object_frame.h"

namespace pliant {

// A directional light that shines on the object (kNoLevelNode: on everything) from the upper right, before it. The
// number of the new node.
std::int32_t add_light(Level& level, std::int32_t object);
// A camera that sees all of the object, a little from above and from the front (+Z). The number of the new node.
std::int32_t add_camera(Level& level, std::int32_t object);

}  // namespace pliant
