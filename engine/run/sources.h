// Sources that move a probe: --probe NAME=SOURCE, and those of the level.
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
  std::string device;  // requested device (devices/choose.h)
  bool held = false;   // by a simulated hand (simulated_hands.h) that follows the path
  std::string words;   // options of the hand
};

// NAME=script:FILE.csv, NAME=orbit, NAME=hand[:WORDS], NAME=mouse or NAME=device:REQUEST.
Result<ProbeSource> parse_source(const std::string& argument);

// Adds a node for each source whose name is not in the level: a point probe with its own device. Call before --set, so
// that keys can be set on it. Error: a node of that name is not a probe, or a name occurs twice.
Status add_probes(Level& level, const std::vector<ProbeSource>& sources);

// The device that moves this probe or tool; created if there is none. Call before the clocks start.
Entity own_device(World& world, Entity hand);

// [m] world. Initial place of this probe or tool in the level. Call before the clocks start.
dvec3 place_of(const World& world, Entity hand);

// Sets the source of each named probe or tool and reads its script. Call after spawn.
Status apply_sources(World& world, const std::vector<ProbeSource>& sources);

// The path `orbit` of one hand; empty if it finds nothing to touch. Call after prepare_touch.
Path orbit_of(const World& world, Entity hand, unsigned index);

// "give it --probe NAME=orbit", or a script where a probe has no surface for an orbit.
std::string moving_cure(const World& world, const std::string& name);

// Makes the paths of every probe and tool with the driver `orbit`. Call after prepare_touch. Returns a sentence for
// each that finds nothing to touch and stays in place.
std::vector<std::string> make_orbits(World& world);

// The simulated hands of --probe NAME=hand. Call after make_orbits.
Result<SimulatedHands> make_hands(World& world, const std::vector<ProbeSource>& sources);

// "script:press.csv", "orbit", "mouse", "null": the source of this probe or tool.
std::string describe_source(const World& world, Entity hand);

}  // namespace pliant
