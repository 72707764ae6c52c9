// Where a hand did not get what the law says: the safety layer's counts (systems/safety/safety.h), in words.
#pragma once

#include <string>
#include <vector>

#include "components/world.h"
#include "systems/safety/safety.h"

namespace pliant {

// Of a probe or tool. Null where nothing prepared it; `torque` of tools alone.
struct HandSafety {
  const SafetyState* force = nullptr;
  const SafetyState* torque = nullptr;
  // Which limits acted in the last tick, as bits 1 << SafetyLimit.
  std::uint8_t now() const;
};
HandSafety find_safety(const World& world, Entity hand);

// One sentence per limit that acted, with how often, how much at most, and the cure. Valid when the clock has stopped.
std::vector<std::string> explain_limits(const World& world, Entity hand, const std::string& name);

// "clipped", "withheld", "gated", "slewed": keys of report.json.
const char* key_of(SafetyLimit limit);

}  // namespace pliant
