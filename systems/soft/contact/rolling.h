// Rolling resistance of rigid bodies.
#pragma once

#include "systems/soft/contact/delassus.h"

namespace pliant {

// Slows rigid bodies that roll on fixed ones by kRolls times the load, a fiftieth of steel on steel, without which a
// ball in a groove never comes to rest. After apply_impulses and keep_impulses.
void resist_rolling(const std::vector<std::unique_ptr<Body>>& bodies, const std::vector<ContactPoint>& contacts,
                    const Delassus& delassus);

}  // namespace pliant
