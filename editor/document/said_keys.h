// Keys that the level says, at their default too: they are saved with it, and no error budget chooses them.
#pragma once

#include <string>
#include <vector>

#include "editor/document/edits.h"

namespace pliant {

struct SaidKey {
  std::string extension, key;  // "deformable", "shape"; "simulation", "soft_step" of the scene
  Json value;
};

// All of them in one edit, of this node or the scene.
Result<State> with_said(const State& state, NodeId id, const std::vector<SaidKey>& keys);
// Back to their defaults, and left out when the level is saved; values are not looked at.
Result<State> without_said(const State& state, NodeId id, const std::vector<SaidKey>& keys);

}  // namespace pliant
