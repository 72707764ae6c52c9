#include "systems/prepare_world.h"

#include "systems/effects/effects.h"
#include "systems/soft/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {

Status prepare_world(World& world) {
  for (const auto prepare_system : {prepare_touch, prepare_effects, prepare_tools, prepare_soft})
    if (const Status status = prepare_system(world); !status) return status;
  return Done{};
}

}  // namespace pliant
