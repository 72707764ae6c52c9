#include "systems/touch/prepare/vary_surfaces.h"

#include "components/varying.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {

void vary_surfaces(World& world, Tick tick) {
  for (auto [entity, varying, deformable] : world.registry.view<const Varying, Deformable>()) {
    const double stiffness = deformable.stiffness, damping_ratio = deformable.damping_ratio;
    vary(varying, tick.time, deformable);
    for (ObjectState& object : world.touch->objects) {
      if (object.entity != entity) continue;
      if (object.stiffness_before == 0.0) object.stiffness_before = deformable.stiffness;
      if (deformable.stiffness != stiffness || deformable.damping_ratio != damping_ratio)
        object.motion = motion(deformable, world.touch->dt);
    }
  }
}

}  // namespace pliant
