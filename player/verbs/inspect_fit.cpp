#include "player/verbs/inspect_fit.h"

#include <fmt/format.h>

#include "engine/choice/model_choice.h"
#include "player/print.h"

namespace pliant {
namespace {

using Json = nlohmann::ordered_json;

Json describe(const ModelChoice& choice) {
  Json tried = Json::array();
  for (std::size_t i = 0; i < choice.tried.size(); ++i) {
    const ModelCandidate& it = choice.tried[i];
    tried.push_back({{"model", it.label},
                     {"error", it.error},
                     {"cost_us", it.cost},
                     {"measured_ms", it.ms > 0.0 ? Json(it.ms) : Json()},
                     {"chosen", i == choice.chosen}});
  }
  return {{"object", choice.object}, {"kind", choice.kind}, {"budget", choice.budget},  {"within", choice.within},
          {"kept", choice.kept},     {"tried", tried},      {"says", choice.sentence()}};
}

}  // namespace

Result<Json> describe_fit(Level& level, double error) {
  if (!level.has_pliant()) make_touchable(level);
  if (error > 0.0)
    if (const Status set = set_error_budget(level, error); !set) return set.error();
  const auto choices = choose_models(level);
  if (!choices) return choices.error();
  if (choices->empty())
    return Error{level.path.string(),
                 "has no object with an error budget; give one the key `error`, or all of them `--error 0.3`"};
  Json fit = Json::array();
  for (const ModelChoice& choice : *choices) fit.push_back(describe(choice));
  return fit;
}

void print_fit(const Json& fit) {
  for (const Json& choice : fit) {
    print("  fit of the {} {}, error at most {:.3g}\n", choice["kind"].get<std::string>(),
          choice["object"].get<std::string>(), choice["budget"].get<double>());
    print("    {:<50} {:>10} {:>14} {:>12}\n", "model", "error [1]", "cost [us/tick]", "measured ms");
    for (const Json& it : choice["tried"])
      print("    {:<50} {:>10.3g} {:>14.3g} {:>12}{}\n", it["model"].get<std::string>(), it["error"].get<double>(),
            it["cost_us"].get<double>(),
            it["measured_ms"].is_null() ? "-" : fmt::format("{:.2g}", it["measured_ms"].get<double>()),
            it["chosen"].get<bool>() ? "  chosen" : "");
    print("    {}\n", choice["says"].get<std::string>());
  }
}

}  // namespace pliant
