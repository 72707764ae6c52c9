#include "player/level/run_replay.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/run/driver_limits.h"
#include "engine/run/scene_hash.h"
#include "systems/device/hands.h"

namespace pliant {
namespace {

// Checks that the recording belongs to this level: same name, rate and probes.
Outcome check_replay(const Recording& replay, const RunOptions& options, const World& world) {
  if (replay.header.level != world.name)
    return failed({options.replay, "was recorded on level '" + replay.header.level + "'; run it on that level"});
  std::vector<std::string> names;
  for (const Entity hand : hands(world)) {
    const Name* name = world.registry.find<Name>(hand);
    names.push_back(name ? name->value : std::string());
  }
  if (names != replay.header.probes)
    return failed({options.replay, "was recorded with other probes than the level has; record it again"});
  return {};
}

}  // namespace

Outcome load_replay(const RunOptions& options, Prepared& run) {
  auto recording = read_recording(options.replay);
  if (!recording) return failed(recording.error());
  run.replay = std::move(recording).value();
  const auto changes =
      std::count_if(run.replay->events.begin(), run.replay->events.end(),
                    [](const RecordedEvent& event) { return event.kind != EventKind::kNewSource || event.tick > 0; });
  if (changes > 0)
    say(run,
        fmt::format("{} holds {} changes that a program made in its run (parameters, forces, pushes, places, sources), "
                    "which are not repeated here: forces will differ; Session::replay repeats them",
                    options.replay, changes));
  return {};
}

void compare_scene(const RunOptions& options, const Level& level, Prepared& run) {
  run.scene = scene_hash(level);
  if (run.replay && run.replay->header.scene == 0)
    say(run, options.replay + kUnknownScene);
  else if (run.replay && run.replay->header.scene != run.scene)
    say(run,
        "the level is not as it was when the recording was made (its files, or --set, --unit, --error or --tool-force "
        "of this run): forces will differ");
}

Outcome apply_replay(const RunOptions& options, Prepared& run) {
  if (const Status status = apply_driver_settings(run.world, run.replay->header.settings); !status)
    return failed({options.replay, "its setting " + status.error().message()});
  if (Outcome wrong = check_replay(*run.replay, options, run.world)) return wrong;
  if (run.replay->header.rate != run.world.simulation.touch_rate)
    return wrong_arguments(
        {"--rate", fmt::format("the recording was made at {} Hz; leave it out", run.replay->header.rate)});
  return {};
}

}  // namespace pliant
