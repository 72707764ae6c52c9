#include "engine/choice/model_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>

#include "engine/choice/choice_parts.h"
#include "engine/choice/surface_truth.h"

namespace pliant {

namespace {

constexpr double kAsNear = 1.01;  // [1] of the smallest error: a smaller one makes no noticeable difference

std::string cost_words(double us) {
  return us < 100.0 ? fmt::format("{:.2g} us", us) : fmt::format("{:.0f} us", us);
}

bool has_surface_budget(const LevelNode& node) {
  return node.deformable && node.deformable->error > 0.0 && node.mesh >= 0;
}
bool has_body_budget(const LevelNode& node) {
  return node.soft_body && node.soft_body->error > 0.0;
}
bool is_tool(const LevelNode& node) {
  return node.handle && (node.rigid_body || node.soft_body);
}

// Chooses a surface, or a body, if it has a budget.
Status choose_object(Level& level, std::size_t index, double& step, ChoiceProgress& progress,
                     std::vector<ModelChoice>& all) {
  if (!has_surface_budget(level.nodes[index])) {
    auto body = choose_body(level, index, step, progress);
    if (!body) return body.error();
    all.push_back(std::move(*body));
    return Done{};
  }
  auto surface = choose_surface(level, index, progress);
  if (!surface) return surface.error();
  all.push_back(std::move(*surface));
  return Done{};
}

// The alternative if no candidate is within the budget.
const char* cure(const std::string& kind) {
  if (kind == "surface") return "; for less, make it a soft body (PLIANT_soft_body)";
  if (kind == "tool") return "; for less, name a shorter soft_step";
  return "; for less, name a smaller `cell` and soft_step";
}

}  // namespace

std::string ModelChoice::sentence() const {
  const ModelCandidate& it = tried[chosen];
  std::string out =
      fmt::format("`{}`: {} is the cheapest of {} within an error of {:.3g}: measured {:.3g}, about {} a tick", object,
                  it.label, tried.size(), budget, it.error, cost_words(it.cost));
  if (!within)
    out = fmt::format(
        "`{}`: none of {} models is within an error of {:.3g}; {} comes nearest, with {:.3g} and about {} a "
        "tick",
        object, tried.size(), budget, it.label, it.error, cost_words(it.cost));
  if (it.cost > kRealTimeUs) out += ", that is slower than real time";
  if (!within) out += cure(kind);
  for (std::size_t i = 0; i < kept.size(); ++i) out += (i == 0 ? "; the level itself says " : ", ") + kept[i];
  for (const std::string& each : presses) out += "; " + each;
  return out;
}

std::size_t cheapest_within(const std::vector<ModelCandidate>& tried, double budget) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < tried.size(); ++i) {
    if (tried[i].error <= budget) return i;
    least = std::min(least, tried[i].error);
  }
  std::size_t nearest = 0;
  while (nearest + 1 < tried.size() && !(tried[nearest].error <= kAsNear * least)) ++nearest;
  return nearest;
}

Result<std::vector<ModelChoice>> choose_models(Level& level) {
  std::vector<ModelChoice> all;
  ChoiceProgress progress;
  double step = 1.0;
  bool any_body = false;
  std::map<std::size_t, std::size_t> body_of;  // node -> index of its body's choice
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (!node.in_scene || !(has_surface_budget(node) || has_body_budget(node))) continue;
    if (const Status done = choose_object(level, i, step, progress, all); !done) return done.error();
    if (has_surface_budget(node)) continue;
    any_body = true;
    body_of[i] = all.size() - 1;
  }
  if (any_body && !states_step(level)) level.simulation.soft_step = step;
  std::vector<ModelChoice> tools;
  for (std::size_t i = 0; i < level.nodes.size() && !all.empty(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (!node.in_scene || !is_tool(node)) continue;
    // A soft tool uses its body's budget, a rigid one the smallest of the level's.
    const auto body = body_of.find(i);
    if (body == body_of.end() && !node.rigid_body) continue;
    ModelChoice& whose = body != body_of.end()
                             ? all[body->second]
                             : *std::min_element(all.begin(), all.end(),
                                                 [](const auto& a, const auto& b) { return a.budget < b.budget; });
    auto choice = choose_tool(level, i, whose, progress);
    if (!choice) return choice.error();
    if (*choice) tools.push_back(std::move(**choice));
  }
  all.insert(all.end(), std::make_move_iterator(tools.begin()), std::make_move_iterator(tools.end()));
  return all;
}

Result<std::vector<ModelChoice>> choose_model(Level& level, std::size_t index, const ChoiceWatch& watch) {
  const LevelNode& node = level.nodes[index];
  if (!node.in_scene) return Error{node.name, "is not in the scene that is shown", "no model of it is chosen"};
  if (!has_surface_budget(node) && !has_body_budget(node))
    return Error{node.name, "has no error budget", "give its surface or soft body the key `error`"};
  ChoiceProgress progress(watch);
  std::vector<ModelChoice> all;
  try {
    double step = 1.0;
    if (const Status done = choose_object(level, index, step, progress, all); !done) return done.error();
    if (has_surface_budget(node)) return all;
    if (!states_step(level)) level.simulation.soft_step = step;
    if (!is_tool(node)) return all;
    auto tool = choose_tool(level, index, all.back(), progress);
    if (!tool) return tool.error();
    if (*tool) all.push_back(std::move(**tool));
    return all;
  } catch (const ChoiceStopped&) {
    return Error{node.name, "was not measured to the end"};
  }
}

std::vector<ChoosableKey> choosable_keys(const Level& level, std::size_t index) {
  const LevelNode& node = level.nodes[index];
  std::vector<ChoosableKey> keys;
  const auto add = [&](const char* extension, const char* key) {
    keys.push_back({extension, key, states(node, extension, key)});
  };
  if (node.soft_body && !has_surface_budget(node)) {
    if (node.soft_body->mesh.empty()) add("soft_body", "cell");
    add("soft_body", "solver");
    keys.push_back({"simulation", "soft_step", states_step(level)});
    if (is_tool(node)) add("handle", "force");
  } else if (node.deformable && node.mesh >= 0) {
    if (!states(node, "deformable", "volume")) add("deformable", "shape");
    for (const char* key : {"distance", "reach", "contact_radius"}) add("deformable", key);
  }
  return keys;
}

Status set_error_budget(Level& level, double budget) {
  bool any = false;
  for (LevelNode& node : level.nodes) {
    if (node.deformable) node.deformable->error = budget, any = true;
    if (node.soft_body) node.soft_body->error = budget, any = true;
  }
  if (any) return Done{};
  return Error{"--error", "the level has neither a deformable surface nor a soft body", "leave it out"};
}

}  // namespace pliant
