#include "player/run/run_findings.h"

#include <fmt/format.h>

#include "engine/run/sources.h"
#include "player/run/tool_words.h"
#include "systems/device/hands.h"
#include "systems/effects/felt_effects.h"
#include "systems/soft/soft_state.h"

namespace pliant {
namespace {

// True if a source in this run could move this probe or tool.
bool is_moved(const RunFigures& figures, std::size_t hand) {
  const HapticDevice* device = find_device(figures.world, figures.journal.probes()[hand]);
  const DriverKind driver = device ? device->driver : DriverKind::kNull;
  if (driver == DriverKind::kMouse) return figures.mode == "window";
  if (driver == DriverKind::kExternal) return figures.replayed || !device->id.empty();
  return driver != DriverKind::kNull;
}

bool is_joined(const World& world, Entity hand) {
  for (auto [entity, joint] : world.registry.view<const Joint>())
    if (joint.body_a == hand || joint.body_b == hand) return true;
  return false;
}

}  // namespace

std::vector<Note> explain_run(RunFigures& figures, DeviceLinks& devices) {
  std::vector<Note> notes;
  const auto add = [&](std::vector<Note> more) {
    for (Note& note : more) notes.push_back(std::move(note));
  };
  for (std::size_t i = 0; i < figures.journal.probes().size(); ++i) {
    const Entity hand = figures.journal.probes()[i];
    const ProbeSummary& summary = figures.keeper.summaries()[i];
    figures.misses.emplace_back();
    if (summary.contact_ticks == 0 && devices.never_ready(hand)) {
      // its device reports the reason
    } else if (summary.contact_ticks == 0 && summary.max_force > 0.0 && figures.world.registry.has<FeltEffects>(hand)) {
      // it felt effects in space
    } else if (summary.contact_ticks == 0 && summary.max_force > 0.0 && is_joined(figures.world, hand)) {
      // it felt what is joined to it
    } else if (summary.contact_ticks == 0 && !is_moved(figures, i)) {
      notes.push_back({fmt::format("{} `{}` never touched anything: nothing moves it", summary.tool ? "tool" : "probe",
                                   summary.name),
                       moving_cure(figures.world, summary.name), kUntouched, summary.name});
    } else if (const Probe* probe = figures.world.registry.find<Probe>(hand); summary.contact_ticks == 0 && probe) {
      figures.misses.back() = find_miss(figures.world, summary.approach, probe->radius);
      notes.push_back(explain_miss(summary.name, figures.misses.back()));
    } else if (summary.contact_ticks == 0) {
      notes.push_back({"tool `" + summary.name + "` never touched anything",
                       "move its device into contact (script, or --probe " + summary.name + "=orbit)", kUntouched,
                       summary.name});
    }
    add(explain_limits(figures.world, hand, summary.name));
    add(explain_tool(figures.world, summary));
  }
  if (figures.soft) add(explain_soft_steps(figures.world, figures.soft->figures()));
  return notes;
}

}  // namespace pliant
