// Extracts one node of a level, for measurements on it.
#pragma once

#include <functional>
#include <string>

#include "components/world.h"
#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

// The level with only this node, at its place and without motion. A tool keeps its handle, without a device.
Level level_alone(const Level& level, std::size_t node);
// The same as a world; `edit` changes the node first.
Result<World> spawn_alone(const Level& level, std::size_t node, const std::function<void(LevelNode&)>& edit);

// True if the author set the key: in the file, by --set, or to a value other than the default.
bool states(const LevelNode& node, const std::string& extension, const std::string& key);
bool states_step(const Level& level);

}  // namespace pliant
