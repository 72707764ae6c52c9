// Keys stated in the level, even at their default: they are saved, and error budgets do not choose them.
#pragma once

#include <string>
#include <vector>

#include "editor/document/edits.h"

namespace pliant {

struct StatedKey {
  std::string extension, key;  // "deformable", "shape"; for the scene "simulation", "soft_step"
  Json value;
};

// Sets all keys in one edit, on this node or the scene.
Result<State> with_stated(const State& state, NodeId id, const std::vector<StatedKey>& keys);
// Resets keys to their defaults and unstates them; ignores the values.
Result<State> without_stated(const State& state, NodeId id, const std::vector<StatedKey>& keys);

}  // namespace pliant
