// Between load and the first tick: sizes every buffer that the touch tick will need, makes one Contact per (probe,
// object) pair, and refuses parameters that no step could survive.
#pragma once

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// Call after spawn, after every structural change, and after a Deformable's parameters changed. Allocates.
// Keeps the heights of fields that already have the right size.
Status prepare_touch(World& world);

// The box of an object's rest surface in world, with room for its curved patches.
Box touch_box(const Mesh& mesh, const Pose& pose);

// Bytes of touch state of one mesh and its field (for reports): everything a tick may read or write.
std::size_t touch_bytes(const Mesh& mesh, const HeightField& field);

}  // namespace pliant
