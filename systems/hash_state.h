// "Same input, same bits": a hash over every field's stream, residual and rate, every probe, every contact and every
// moving node.
#pragma once

#include "components/world.h"
#include "runtime/hash.h"

namespace pliant {

void hash_state(const World& world, Hash& hash);   // the whole simulation state; reads every vertex
void hash_forces(const World& world, Hash& hash);  // every device's force; cheap, for use each tick

}  // namespace pliant
