// One node of a level by itself: what a measurement presses.
#pragma once

#include <functional>
#include <string>

#include "components/world.h"
#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

// The level with nothing but this node, at its place, without what moves it. A tool keeps its handle, without a device.
Level level_alone(const Level& level, std::size_t node);
// The same as a world; `edit`: of the node, before.
Result<World> spawn_alone(const Level& level, std::size_t node, const std::function<void(LevelNode&)>& edit);

// Whether a key is the author's: said in the file, by --set, or not at its default.
bool states(const LevelNode& node, const std::string& extension, const std::string& key);
bool states_step(const Level& level);

}  // namespace pliant
