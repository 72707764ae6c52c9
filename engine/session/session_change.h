// Changes of parameters between ticks: an object's new value, checked, as edits for the clocks.
#pragma once

#include "engine/session/live_keys.h"
#include "engine/session/session_run.h"
#include "systems/soft/soft_state.h"

namespace pliant {

// Changes to send to the clocks.
struct SessionChange {
  Entity entity;
  std::vector<Edit> touch;
  std::vector<ParameterEdit> soft;
};

// Checks and makes the changes that follow from the new value of `key`, which `node` contains. `where`: of the sentence
// of an error.
Result<SessionChange> change_of(SessionRun& p, const std::string& name, const std::string& where,
                                const Extension& extension, const Key& key, LevelNode& node);

}  // namespace pliant
