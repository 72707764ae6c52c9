// What people hold: probes (P1) and tools (P2). Both are moved by a device and push back through it.
#pragma once

#include <vector>

#include "components/world.h"

namespace pliant {

// Every Probe, then every tool (an entity with Handle6 and SoftBody), each in the order of its making.
std::vector<Entity> hands(const World& world);

// The device that moves this probe or tool; null where nobody does.
Entity device_of(const World& world, Entity hand);
const HapticDevice* find_device(const World& world, Entity hand);

}  // namespace pliant
