// Relief that is drawn and not felt.
#pragma once

#include <optional>

#include "content/level/level.h"

namespace pliant {

// Whether a material of the node's mesh draws relief on it.
bool draws_relief(const Level& level, const LevelNode& node);
// One note for all surfaces whose materials draw relief while `relief` is 0 and not stated.
std::optional<Note> unfelt_relief(const Level& level);

}  // namespace pliant
