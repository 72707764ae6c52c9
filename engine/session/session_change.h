// Changes of parameters between ticks: an object's new value, checked, as edits for the clocks.
#pragma once

#include "content/keys/live_keys.h"
#include "engine/session/live_edit.h"
#include "systems/soft/soft_state.h"

namespace pliant {

// Changes to send to the clocks.
struct SessionChange {
  Entity entity;
  std::vector<Edit> touch;
  std::vector<ParameterEdit> soft;
};

// The meaning of a name of a prepared world, and its extensions with the values that its owner set last. Without a device,
// an object and so on, that entity is kNoEntity.
struct LiveNamed {
  std::string name;
  Entity object = kNoEntity, hand = kNoEntity, device = kNoEntity, effect = kNoEntity;
  bool several_effects = false;  // of this name
  LevelNode node;
};

// Checks and makes the changes that follow from the new value of `key`, which `now` contains. `where`: of the sentence
// of an error.
Result<SessionChange> change_of(const World& world, const LiveNamed& named, const std::string& where,
                                const Extension& extension, const Key& key, LevelNode& now);

}  // namespace pliant
