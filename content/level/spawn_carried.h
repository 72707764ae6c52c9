// Attaches the drawn parts inside a deformable object to it (Carried), or notes that they stay where they are.
#pragma once

#include "content/level/spawn_state.h"

namespace pliant {

// Of all nodes; after all of them have their entities and meshes.
Status carry_parts(SpawnState& state);

}  // namespace pliant
