// Model only what a scene needs: objects with an error budget (`error` of PLIANT_deformable and PLIANT_soft_body) get
// the cheapest model whose error, measured on that very object, is within it.
//
// Surfaces: every shape, with distance straight or along the surface, pressed in the touch tick itself at several
// places; the truth is an elastic half-space under a flat punch of a fifth of the reach, its distances along the
// surface. Soft bodies: lattices and soft steps, pressed at several places; the truths are a lattice of 0.6 usual
// cells, and the midpoint rule in short steps.
//
// What is chosen must not depend on the machine: costs are counted, not timed. What the level says itself by a key is
// not chosen.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

struct ModelCandidate {
  std::string label;   // "shape punch, distance chord"
  double error = 0.0;  // [1] measured on the object
  double cost = 0.0;   // [us of a tick of 1 ms] counted, for the machine of bench/results
  double ms = 0.0;     // [ms] what one of its ticks or steps took on this machine, where it was measured; 0: was not
};

struct ModelChoice {
  std::string object, kind;           // "surface" or "soft body"
  double budget = 0.0;                // [1]
  std::vector<ModelCandidate> tried;  // the cheapest first
  std::size_t chosen = 0;             // into `tried`
  bool within = false;                // the budget
  std::vector<std::string> kept;      // keys that the level says itself
  std::vector<std::string> presses;   // further sentences: what could not be measured
  std::string sentence() const;       // what was chosen and why
};

// Of candidates, cheapest first: the first within the budget, else the one with the least error.
std::size_t cheapest_within(const std::vector<ModelCandidate>& tried, double budget);

// Sets the keys of every object that has a budget. Takes seconds where there is one, says so, and does nothing where
// there is none. `level` has been checked (check_level_size) and is otherwise as spawn_level wants it.
Result<std::vector<ModelChoice>> choose_models(Level& level);

// --error of a command: the budget of every surface and soft body of the level. An error where there is none.
Status set_error_budget(Level& level, double budget);

}  // namespace pliant
