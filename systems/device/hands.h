// Hand-held objects: probes (P1) and tools (P2). Both are moved by a device and return force through it.
#pragma once

#include <string>
#include <vector>

#include "components/world.h"

namespace pliant {

// Every Probe, then every tool (an entity with Handle6 and SoftBody), each in order of creation.
std::vector<Entity> hands(const World& world);

// The device that moves this probe or tool; null without one.
Entity device_of(const World& world, Entity hand);
const HapticDevice* find_device(const World& world, Entity hand);

// A probe that its caller moves by its device's position; its force is not limited.
Entity add_free_probe(World& world, const std::string& name, double radius, dvec3 position);

}  // namespace pliant
