// Keys of a surface that an animation varies.
#pragma once

#include "content/level/spawn_state.h"

namespace pliant {

// Adds Varying to the node's entity, which has its Deformable and mesh, if any animation varies it; the surface begins
// with the first values. Errors name the node: a key that follows from another, or that is painted and prepared.
Status add_varying(SpawnState& state, std::size_t n);

}  // namespace pliant
