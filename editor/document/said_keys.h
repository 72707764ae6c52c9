// Keys stated in the level, even at their default: they are saved, and error budgets do not choose them.
#pragma once

#include <string>
#include <vector>

#include "editor/document/edits.h"

namespace pliant {

struct SaidKey {
  std::string extension, key;  // "deformable", "shape"; for the scene "simulation", "soft_step"
  Json value;
};

// Sets all keys in one edit, on this node or the scene.
Result<State> with_said(const State& state, NodeId id, const std::vector<SaidKey>& keys);
// Resets keys to their defaults and unstates them; ignores the values.
Result<State> without_said(const State& state, NodeId id, const std::vector<SaidKey>& keys);

}  // namespace pliant
