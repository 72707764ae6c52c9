// The name of an entity.
#pragma once

#include <string>

#include "components/world.h"

namespace pliant {

inline std::string name_of(const World& world, Entity entity, std::string without = {}) {
  const Name* const name = world.registry.find<Name>(entity);
  return name ? name->value : without;
}

}  // namespace pliant
