// What moves a probe: --probe NAME=SOURCE, and what the level says itself.
#pragma once

#include <string>
#include <vector>

#include "components/world.h"
#include "content/level/level.h"
#include "engine/run/simulated_hands.h"
#include "runtime/result.h"

namespace pliant {

struct ProbeSource {
  std::string name;  // of the probe or tool
  DriverKind driver = DriverKind::kOrbit;
  std::string file;    // of a script, relative to the working directory
  std::string device;  // which one (devices/choose.h)
  bool held = false;   // by a simulated hand (simulated_hands.h), which wants to follow that path
  std::string words;   // of the hand
};

// NAME=script:FILE.csv, NAME=orbit, NAME=hand[:WORDS], NAME=mouse or NAME=device:WISH.
Result<ProbeSource> parse_source(const std::string& argument);

// Adds a node for each source that names no node of the level: a point probe with a device of its own. Before --set, so
// that keys reach it. Fails where a node of that name is not a probe, and where a name comes twice.
Status add_probes(Level& level, const std::vector<ProbeSource>& sources);

// The device that moves this probe or tool; made where there is none. Before the clocks start.
Entity own_device(World& world, Entity hand);

// Where the level put this probe or tool. [m] world. Before the clocks start.
dvec3 place_of(const World& world, Entity hand);

// Gives each named probe or tool its source; scripts are read. Call after spawn.
Status apply_sources(World& world, const std::vector<ProbeSource>& sources);

// The path `orbit` of one; empty where it finds nothing to touch. Call after prepare_touch.
Path orbit_of(const World& world, Entity hand, unsigned index);

// Makes the paths of every probe and tool whose driver is `orbit`. Call after prepare_touch. Says who found nothing to
// touch and is held where it stands.
std::vector<std::string> make_orbits(World& world);

// The simulated hands of --probe NAME=hand. Call after make_orbits.
Result<SimulatedHands> make_hands(World& world, const std::vector<ProbeSource>& sources);

// "script:press.csv", "orbit", "mouse", "null": what moves this probe or tool.
std::string describe_source(const World& world, Entity hand);

}  // namespace pliant
