// Chooses how the touch clock computes a tool's force, by pressing that tool on a fixed plate.
#include <fmt/format.h>

#include <cmath>

#include "content/keys/enum_words.h"
#include "engine/choice/choice_parts.h"
#include "engine/choice/tool_press.h"
#include "systems/tool/handle_model.h"

namespace pliant {
namespace {

// [us] per tick, as measured by `pliant study linearisation` (bench/results/studies/linearisation.json: 20 us with 58
// contacts and 69 modes): coupling and handle; the linear model; each entry of the contact rows.
constexpr double kHeldUs = 0.5, kLinearUs = 0.1, kEntryUs = 1.5e-3;

double cost_us(ToolForce force, int contacts, int modes) {
  if (force == ToolForce::kHeld) return kHeldUs;
  if (force == ToolForce::kLinear) return kHeldUs + kLinearUs;
  return kHeldUs + kLinearUs + kEntryUs * 3.0 * contacts * (modes + 6.0);
}

// [1] RMS difference of the forces over the RMS of the reference's change since its start. The reference has every
// `every`-th tick.
double difference(const std::vector<Vector6>& felt, const std::vector<Vector6>& truth, std::size_t every) {
  double off = 0.0, size = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    off += (felt[i * every] - truth[i]).head<3>().squaredNorm();
    size += (truth[i] - truth[0]).head<3>().squaredNorm();
  }
  return size > 0.0 ? std::sqrt(off / size) : 0.0;
}

}  // namespace

Result<std::optional<ModelChoice>> choose_tool(Level& level, std::size_t index, ModelChoice& whose,
                                               ChoiceProgress& progress) {
  LevelNode& node = level.nodes[index];
  ModelChoice choice{node.name, "tool", whose.budget, {}, 0, false, {}, {}};
  auto press = ToolPress::make(level, index);
  if (!press) return press.error();
  if (!press->unmeasured().empty()) {
    whose.presses.push_back(fmt::format("the force of the tool `{}` was not measured, and stays {}: {}", node.name,
                                        word_of(node.handle->force), press->unmeasured()));
    return std::optional<ModelChoice>();
  }
  const auto truth = press->truth(progress);
  if (!truth) return truth.error();
  double most = 0.0;
  for (const Vector6& each : truth->wrench) most = std::max(most, (each - truth->wrench[0]).head<3>().norm());
  if (!(most > 0.0)) return Error{node.name, "could not be pressed to measure its force", "leave out `error`"};
  std::vector<ToolForce> forces{ToolForce::kHeld, ToolForce::kLinear, ToolForce::kContacts};
  if (states(node, "handle", "force")) {
    choice.kept.emplace_back("force");
    forces = {node.handle->force};
  }
  std::vector<std::pair<ModelCandidate, ToolForce>> tried;
  ToolPress::Felt last;
  for (const ToolForce force : forces) {
    auto felt = press->touched(force);
    if (!felt) return felt.error();
    ModelCandidate candidate;
    candidate.label = fmt::format("force {}, soft step {:.3g} ms", word_of(force), 1e3 * level.simulation.soft_step);
    candidate.error = difference(felt->wrench, truth->wrench, press->truth_ticks());
    candidate.cost = cost_us(force, felt->contacts, felt->modes);
    candidate.ms = felt->ms;
    tried.emplace_back(candidate, force);
    last = std::move(*felt);
  }
  choice.remarks.push_back(fmt::format(
      "truth: what the hand feels, up to {:.2g} N, by soft steps of {:.3g} ms ({}; {:.2g} ms each on this machine), "
      "pressed {:.2g} mm beyond a plate below it and drawn along; models come one soft step late",
      most, 1e3 * press->truth_step(),
      press->truth_ticks() == 1 ? "the touch rate's" : "those of the touch rate would take too long", truth->ms,
      1e3 * press->depth()));
  choice.remarks.push_back(fmt::format(
      "modes: up to {} of {} that a model has room for, at {} contacts; what they leave out of the contacts' static "
      "flexibility, at most {:.2g} of it, is kept without inertia, so there is nothing to choose",
      last.modes, kMaxModes, last.contacts, last.left_out));
  if (!states(node, "handle", "force")) choice.keys.push_back({"handle", "force"});
  node.handle->force = take_cheapest(choice, tried);
  return std::optional(std::move(choice));
}

}  // namespace pliant
