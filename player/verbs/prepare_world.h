// What a run prepares before its first tick, as `validate` and `convert` try it.
#pragma once

#include "components/world.h"
#include "runtime/result.h"
#include "systems/soft/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/touch/prepare.h"

namespace pliant {

inline Status prepare_world(World& world) {
  for (const auto prepare_system : {prepare_touch, prepare_tools, prepare_soft})
    if (const Status status = prepare_system(world); !status) return status;
  return Done{};
}

}  // namespace pliant
