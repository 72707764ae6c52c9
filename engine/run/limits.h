// Sentences about limited forces, from the counts of the safety layer (systems/safety/safety.h).
#pragma once

#include <string>
#include <vector>

#include "components/world.h"
#include "systems/safety/safety.h"

namespace pliant {

// Safety states of a probe or tool. Null if not prepared; `torque` of tools only.
struct HandSafety {
  const SafetyState* force = nullptr;
  const SafetyState* torque = nullptr;
  // Limits that acted in the last tick, as bits 1 << SafetyLimit.
  std::uint8_t now() const;
};
HandSafety find_safety(const World& world, Entity hand);

// A note per limit that acted, with its frequency, its largest value and the remedy: "force.clipped",
// "torque.withheld", ... Valid when the clock has stopped.
std::vector<Note> explain_limits(const World& world, Entity hand, const std::string& name);

// "clipped", "withheld", "gated", "slewed": keys of report.json.
const char* key_of(SafetyLimit limit);

}  // namespace pliant
