// "Same input, same bits" for all soft and rigid bodies and for tools.
#pragma once

#include "components/world.h"
#include "runtime/hash.h"

namespace pliant {

void hash_soft(const World& world, Hash& hash);  // bodies, contacts and handles; reads every collision mesh vertex
void hash_tool_forces(const World& world, Hash& hash);  // every tool's force and torque; cheap, for use each tick

}  // namespace pliant
