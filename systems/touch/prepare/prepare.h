// Between load and the first tick: sizes every buffer of the touch tick, makes one Contact per (probe, object) pair,
// and rejects parameters for which the step fails.
#pragma once

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// Call after spawn, after every structural change, and after a Deformable's parameters changed. Allocates.
// Keeps the heights of fields that already have the right size.
Status prepare_touch(World& world);

// The world box of an object's rest surface, including its curved patches.
Box touch_box(const Mesh& mesh, const Pose& pose);
// Puts an object's box, and its leaf among the objects, where its Pose is now.
void renew_box(const World& world, TouchState& touch, std::uint32_t slot);

// Bytes of touch state of one mesh and its field (for reports): everything that a tick may read or write.
std::size_t touch_bytes(const Mesh& mesh, const HeightField& field);

}  // namespace pliant
