// The parts of model_choice.h, one a kind of object.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "engine/choice/alone.h"
#include "engine/choice/model_choice.h"
#include "runtime/long_work.h"

namespace pliant {

// Thrown through a choice whose watch has ended it; caught by choose_model.
struct ChoiceStopped {};

// Tells the watch, or without one stderr, that the choice goes on.
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

// Each sets the keys of the node that are not stated.
Result<ModelChoice> choose_surface(Level& level, std::size_t node, ChoiceProgress& progress);
// After the surface, whose choice this is: nothing where nothing says what the force should be, and a remark says why.
Result<std::optional<ModelChoice>> choose_law(Level& level, std::size_t node, ModelChoice& surface,
                                              ChoiceProgress& progress);
// `step` [s] is what the bodies of the level need.
Result<ModelChoice> choose_body(Level& level, std::size_t node, double& step, ChoiceProgress& progress);
// After all bodies: with the level's soft step. `whose`: the choice whose budget it has. Nothing where it would take
// too long to measure, and `whose` says so.
Result<std::optional<ModelChoice>> choose_tool(Level& level, std::size_t node, ModelChoice& whose,
                                               ChoiceProgress& progress);

// What a candidate stands for goes with it while they are sorted: the cheapest first, and the one to take.
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
