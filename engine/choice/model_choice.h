// Model only what a scene needs: objects with an error budget (`error` of PLIANT_deformable and PLIANT_soft_body) get
// the cheapest model whose error, measured on that very object, is within it.
//
//   surface     shape, distance, reach and contact radius, pressed by the touch tick; the truth is an elastic
//   half-space
//               or a bonded layer under a flat punch (surface_truth.h)
//   force law   spring with its constant, where `young` and a spherical probe say what the force should be
//   soft body   lattice, soft step and solver; the truths are a finer lattice, the midpoint rule in short steps, and a
//               refined direct solution
//   tool        held force, linear model or contacts solved again; the truth is the soft step at the touch rate
//
// What is chosen must not depend on the machine: costs are counted, not timed. What the level says itself by a key is
// not chosen.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "components/range.h"
#include "content/level/level.h"
#include "runtime/result.h"

namespace pliant {

struct ModelCandidate {
  std::string label;      // "shape punch, distance chord"
  double error = 0.0;     // [1] measured on the object
  double cost = 0.0;      // [us of a tick of 1 ms] counted, for the machine of bench/results
  double ms = 0.0;        // [ms] what one of its ticks or steps took on this machine, where it was measured; 0: was not
  double vertices = 0.0;  // awake in a press of a surface; 0: no surface
};

// A key that a budget chooses, of the node or the scene.
struct ChoosableKey {
  std::string extension, key;  // "deformable", "shape"
  bool said = false;           // by the level, --set, or a value that is not the default
};

struct ModelChoice {
  std::string object, kind;           // "surface", "force law", "soft body" or "tool"
  double budget = 0.0;                // [1]
  std::vector<ModelCandidate> tried;  // the cheapest first
  std::size_t chosen = 0;             // into `tried`
  bool within = false;                // the budget
  std::vector<std::string> kept;      // keys that the level says itself
  std::vector<std::string> presses;   // further sentences: what could not be measured
  std::vector<std::string> remarks;   // what there is nothing to choose between, with its measured numbers
  std::vector<ChoosableKey> keys;     // that it chose
  std::string sentence() const;       // what was chosen and why, without the remarks
};

inline constexpr double kRealTimeUs = 1000.0;  // [us of a tick of 1 ms] above: slower than real time

// Of candidates, cheapest first: the first within the budget, else the first whose error is the least within 1 %.
std::size_t cheapest_within(const std::vector<ModelCandidate>& tried, double budget);

// Sets the keys of every object that has a budget. Takes seconds where there is one, says so, and does nothing where
// there is none. `level` has been checked (check_level_size) and is otherwise as spawn_level wants it.
Result<std::vector<ModelChoice>> choose_models(Level& level);

// Told between two measurements what is being done, on the thread that measures; false ends the choice.
using ChoiceWatch = std::function<bool(const std::string& doing)>;
// The same for one object: what choose_models finds for it, and of a soft body's handle too. Sets the keys of that
// object and, of a soft body, the level's soft step to what this body alone needs. Progress goes to `watch`, without
// one to stderr. An error where the object has no budget, cannot be pressed, or `watch` has ended it.
Result<std::vector<ModelChoice>> choose_model(Level& level, std::size_t node, const ChoiceWatch& watch = {});

// The keys that the budget of an object would choose; those that are said stay as they are. Without what other keys
// decide: `cell` where its tetrahedra come from a file, `shape` where `volume` is said. Empty where the node is neither
// a surface nor a soft body.
std::vector<ChoosableKey> choosable_keys(const Level& level, std::size_t node);

inline constexpr Range kErrorBudget{1e-6, 10.0};  // [1] of --error
// --error of a command: the budget of every surface and soft body of the level. An error where there is none.
Status set_error_budget(Level& level, double budget);

}  // namespace pliant
