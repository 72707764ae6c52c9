// The parts of model_choice.h, one per kind of object.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "engine/choice/alone.h"
#include "engine/choice/model_choice.h"
#include "runtime/long_work.h"

namespace pliant {

// Thrown when the watch ends a choice; caught by choose_model.
struct ChoiceStopped {};

// Reports progress to the watch, or to stderr without one.
class ChoiceProgress {
 public:
  explicit ChoiceProgress(const ChoiceWatch& watch = {}) : watch_(watch) {}
  void say(const std::string& doing) {
    if (!watch_)
      work_.say(doing);
    else if (!watch_(doing))
      throw ChoiceStopped{};
  }

 private:
  ChoiceWatch watch_;
  LongWork work_;
};

// Each sets the keys of the node that the author has not set.
Result<ModelChoice> choose_surface(Level& level, std::size_t node, ChoiceProgress& progress);
// `step` [s]: lowered to the soft step chosen for this body.
Result<ModelChoice> choose_body(Level& level, std::size_t node, double& step, ChoiceProgress& progress);
// Called after all bodies, with the level's soft step. `whose`: the choice that has the budget. Empty if the
// measurement would take too long; `whose` then notes it.
Result<std::optional<ModelChoice>> choose_tool(Level& level, std::size_t node, ModelChoice& whose,
                                               ChoiceProgress& progress);

// Sorts candidates by cost, keeping the model that each stands for, and returns the one to take.
template <class What>
const What& take_cheapest(ModelChoice& choice, std::vector<std::pair<ModelCandidate, What>>& tried) {
  std::stable_sort(tried.begin(), tried.end(),
                   [](const auto& a, const auto& b) { return a.first.cost < b.first.cost; });
  for (const auto& [candidate, what] : tried) choice.tried.push_back(candidate);
  choice.chosen = cheapest_within(choice.tried, choice.budget);
  choice.within = choice.tried[choice.chosen].error <= choice.budget;
  return tried[choice.chosen].second;
}

}  // namespace pliant
