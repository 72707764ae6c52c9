// Chooses models by error budget. An object with an `error` (PLIANT_deformable and PLIANT_soft_body) gets the cheapest
// model whose error, measured on that object, is within it.
//
//   surface     shape, distance, reach and contact radius, pressed by the touch tick; reference: an elastic half-space
//               or a bonded layer under a flat punch (surface_truth.h)
//   soft body   lattice, soft step and solver; references: a finer lattice, the midpoint rule in short steps, and a
//               refined direct solution
//   tool        constant force, linear model or contacts solved again; reference: the soft step at the touch rate
//
// The choice must not depend on the machine: costs are counted, not timed. Keys that the level sets are not chosen.
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
  double cost = 0.0;      // [us per tick of 1 ms] counted, for the machine of bench/results
  double ms = 0.0;        // [ms] of one of its ticks or steps, measured on this machine; 0: not measured
  double vertices = 0.0;  // awake in a press of a surface; 0: not a surface
};

// A key, of the node or the scene, that a budget chooses.
struct ChoosableKey {
  std::string extension, key;  // "deformable", "shape"
  bool said = false;           // set by the level, --set, or a value other than the default
};

struct ModelChoice {
  std::string object, kind;           // "surface", "soft body" or "tool"
  double budget = 0.0;                // [1]
  std::vector<ModelCandidate> tried;  // the cheapest first
  std::size_t chosen = 0;             // into `tried`
  bool within = false;                // the budget
  std::vector<std::string> kept;      // keys that the level sets
  std::vector<std::string> presses;   // further sentences: what could not be measured
  std::vector<std::string> remarks;   // aspects without alternatives, with their measured numbers
  std::vector<ChoosableKey> keys;     // keys that it chose
  std::string sentence() const;       // the choice and its reason, without the remarks
};

inline constexpr double kRealTimeUs = 1000.0;  // [us per tick of 1 ms] above: slower than real time

// `tried` is sorted by cost. Returns the first within the budget; if there is none, the first whose error is within 1 %
// of the smallest.
std::size_t cheapest_within(const std::vector<ModelCandidate>& tried, double budget);

// Sets the keys of every object that has a budget. With budgets it takes seconds and reports progress; without it does
// nothing. `level` has been checked (check_level_size) and otherwise meets the conditions of spawn_level.
Result<std::vector<ModelChoice>> choose_models(Level& level);

// Called between two measurements with a description of the next, on the measuring thread; returning false ends the
// choice.
using ChoiceWatch = std::function<bool(const std::string& doing)>;
// The same for one object, including a soft body's handle. Sets the keys of that object and, for a soft body, the
// level's soft step to the needs of this body alone. Progress goes to `watch`, or to stderr without one. Error: the
// object has no budget, cannot be pressed, or `watch` ended the choice.
Result<std::vector<ModelChoice>> choose_model(Level& level, std::size_t node, const ChoiceWatch& watch = {});

// Keys that an object's budget would choose; keys already set are kept. Excludes keys determined by others: `cell` if
// the tetrahedra come from a file, `shape` if `volume` is set. Empty if the node is neither a surface nor a soft body.
std::vector<ChoosableKey> choosable_keys(const Level& level, std::size_t node);

inline constexpr Range kErrorBudget{1e-6, 10.0};  // [1] of --error
// Applies --error of a command: sets the budget of every surface and soft body of the level. Error if there is none.
Status set_error_budget(Level& level, double budget);

}  // namespace pliant
