// Checks a new value of a key against the key table of the level format, for a session or a window's run.
#pragma once

#include <string>
#include <vector>

#include "engine/session/session_change.h"
#include "pliant/session.h"

namespace pliant {

std::vector<const Extension*> extensions_of(const LiveNamed& named);
NamedKind kind_of(const LiveNamed& named);
std::vector<std::string> live_keys_of(const LiveNamed& named);

struct FoundKey {
  const Extension* extension = nullptr;
  const Key* key = nullptr;
};
// `live`: an existing key that cannot change is an error with its reason.
Result<FoundKey> find_named_key(const LiveNamed& named, const std::string& key, bool live);

// A value that was accepted: the changes for the clocks, and the keys with it.
struct LiveSet {
  const Extension* extension = nullptr;
  const Key* key = nullptr;
  Json value;
  LevelNode now;
  SessionChange change;
  std::string words() const;  // "deformable.stiffness=500", for a recording's event
};
Result<LiveSet> live_set(const World& world, const LiveNamed& named, const std::string& key, Json value);

}  // namespace pliant
