#include "player/verbs/inspect_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/choice/model_choice.h"
#include "lab/console/print.h"

namespace pliant {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double kUsualBudget = 0.1;   // [1] for a mesh without extensions, which has no budget
constexpr std::size_t kMostRows = 12;  // a table with more candidates omits dominated ones

OrderedJson describe(const ModelChoice& choice) {
  OrderedJson tried = OrderedJson::array();
  for (std::size_t i = 0; i < choice.tried.size(); ++i) {
    const ModelCandidate& it = choice.tried[i];
    tried.push_back({{"model", it.label},
                     {"error", it.error},
                     {"cost_us", it.cost},
                     {"measured_ms", it.ms > 0.0 ? OrderedJson(it.ms) : OrderedJson()},
                     {"chosen", i == choice.chosen}});
  }
  return {{"object", choice.object}, {"kind", choice.kind}, {"budget", choice.budget},   {"within", choice.within},
          {"kept", choice.kept},     {"tried", tried},      {"says", choice.sentence()}, {"remarks", choice.remarks}};
}

}  // namespace

Result<OrderedJson> describe_fit(Level& level, double error) {
  const bool bare = !level.has_pliant();
  if (bare) make_touchable(level);
  if (bare && !(error > 0.0)) error = kUsualBudget;
  if (error > 0.0)
    if (const Status set = set_error_budget(level, error); !set) return set.error();
  const auto choices = choose_models(level);
  if (!choices) return choices.error();
  if (choices->empty())
    return Error{level.path.string(), "has no object with an error budget",
                 "give one the key `error`, or all of them `--error 0.3`"};
  OrderedJson fit = OrderedJson::array();
  for (const ModelChoice& choice : *choices) fit.push_back(describe(choice));
  return fit;
}

// Selects the candidates, sorted by cost, that are not dominated (no cheaper one has as small an error), and the chosen
// one.
void print_fit(const OrderedJson& fit) {
  for (const OrderedJson& choice : fit) {
    print("  fit of the {} {}, error at most {:.3g}\n", choice["kind"].get<std::string>(),
          choice["object"].get<std::string>(), choice["budget"].get<double>());
    std::size_t width = 20, others = 0;
    for (const OrderedJson& it : choice["tried"]) width = std::max(width, it["model"].get<std::string>().size());
    print("    {:<{}} {:>10} {:>14} {:>12}\n", "model", width, "error [1]", "cost [us/tick]", "measured ms");
    double least = std::numeric_limits<double>::infinity();
    for (const OrderedJson& it : choice["tried"]) {
      const double error = it["error"].get<double>();
      if (choice["tried"].size() > kMostRows && error >= least && !it["chosen"].get<bool>()) {
        ++others;
        continue;
      }
      least = std::min(least, error);
      print("    {:<{}} {:>10.3g} {:>14.3g} {:>12}{}\n", it["model"].get<std::string>(), width, error,
            it["cost_us"].get<double>(),
            it["measured_ms"].is_null() ? "-" : fmt::format("{:.2g}", it["measured_ms"].get<double>()),
            it["chosen"].get<bool>() ? "  chosen" : "");
    }
    if (others > 0) print("    and {} that cost as much or more for no smaller an error (--json has them)\n", others);
    print("    {}\n", choice["says"].get<std::string>());
    for (const OrderedJson& each : choice["remarks"]) print("    {}\n", each.get<std::string>());
  }
}

}  // namespace pliant
