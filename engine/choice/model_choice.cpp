#include "engine/choice/model_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "content/keys/extension_table.h"
#include "engine/choice/choice_parts.h"

namespace pliant {

std::string ModelChoice::sentence() const {
  const ModelCandidate& it = tried[chosen];
  std::string out = fmt::format(
      "`{}`: {} is the cheapest of {} within an error of {:.3g}: measured {:.3g}, about {:.2g} us "
      "a tick",
      object, it.label, tried.size(), budget, it.error, it.cost);
  if (!within)
    out = fmt::format(
        "`{}`: none of {} models is within an error of {:.3g}; {} comes nearest, with {:.3g} and about {:.2g} us a "
        "tick{}",
        object, tried.size(), budget, it.label, it.error, it.cost,
        kind == "surface" ? "; for less, make it a soft body (PLIANT_soft_body)"
                          : "; for less, name a smaller `cell` and soft_step");
  for (std::size_t i = 0; i < kept.size(); ++i) out += (i == 0 ? "; the level itself says " : ", ") + kept[i];
  for (const std::string& each : presses) out += "; " + each;
  return out;
}

std::size_t cheapest_within(const std::vector<ModelCandidate>& tried, double budget) {
  for (std::size_t i = 0; i < tried.size(); ++i)
    if (tried[i].error <= budget) return i;
  return static_cast<std::size_t>(
      std::min_element(tried.begin(), tried.end(),
                       [](const ModelCandidate& a, const ModelCandidate& b) { return a.error < b.error; }) -
      tried.begin());
}

bool states(const LevelNode& node, const std::string& extension, const std::string& key) {
  if (node.stated.contains(extension + "." + key)) return true;
  const Extension* table = find_extension(extension);
  LevelNode defaults;
  table->add(&defaults);
  const Key* it = find_key(*table, key);
  return it->get(&node) != it->get(&defaults);
}

bool states_step(const Level& level) {
  return level.stated.contains("simulation.soft_step") || level.simulation.soft_step != Simulation{}.soft_step;
}

Result<World> spawn_alone(const Level& level, std::size_t node, double cell) {
  Level alone;
  alone.name = level.name;
  alone.path = level.path;
  alone.simulation = level.simulation;
  alone.nodes = level.nodes;
  for (std::size_t i = 0; i < alone.nodes.size(); ++i) {
    LevelNode& each = alone.nodes[i];
    each.probe.reset();
    each.device.reset();
    each.motion.reset();
    each.rigid_body.reset();
    each.light.reset();
    each.camera.reset();
    if (each.handle) each.handle->device.clear();
    if (i == node) continue;
    each.deformable.reset();
    each.soft_body.reset();
    each.handle.reset();
    each.mesh = -1;
  }
  if (alone.nodes[node].soft_body) alone.nodes[node].soft_body->cell = cell;
  if (std::int32_t& mesh = alone.nodes[node].mesh; mesh >= 0) {
    alone.meshes = {level.meshes[static_cast<std::size_t>(mesh)]};
    for (Primitive& primitive : alone.meshes[0].primitives) primitive.material = -1;
    mesh = 0;
  }
  return spawn_level(alone);
}

Result<std::vector<ModelChoice>> choose_models(Level& level) {
  std::vector<ModelChoice> all;
  double step = level.simulation.soft_step;
  bool any_body = false;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    LevelNode& node = level.nodes[i];
    if (!node.in_scene) continue;
    const bool surface = node.deformable && node.deformable->error > 0.0 && node.mesh >= 0,
               body = node.soft_body && node.soft_body->error > 0.0;
    if (!surface && !body) continue;
    if (body && !any_body) step = 1.0;
    auto choice = surface ? choose_surface(level, i) : choose_body(level, i, step);
    if (!choice) return choice.error();
    any_body = any_body || body;
    all.push_back(std::move(*choice));
  }
  if (any_body && !states_step(level)) level.simulation.soft_step = step;
  return all;
}

Status set_error_budget(Level& level, double budget) {
  bool any = false;
  for (LevelNode& node : level.nodes) {
    if (node.deformable) node.deformable->error = budget, any = true;
    if (node.soft_body) node.soft_body->error = budget, any = true;
  }
  if (any) return Done{};
  return Error{"--error", "the level has neither a deformable surface nor a soft body; leave it out"};
}

}  // namespace pliant
