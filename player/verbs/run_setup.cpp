#include "player/verbs/run_setup.h"

#include <fmt/format.h>

#include <algorithm>

#include "content/keys/enum_words.h"
#include "content/level/spawn_soft.h"
#include "content/level_file.h"
#include "content/safety_cap.h"
#include "engine/sources.h"
#include "player/run/unfelt.h"
#include "player/verbs/content_folder.h"
#include "player/verbs/unit.h"
#include "systems/device/hands.h"
#include "systems/device/repeat.h"
#include "systems/soft/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/touch/local_model.h"
#include "systems/touch/prepare.h"
#include "systems/visual/field_cost.h"

namespace pliant {
namespace {

// The recording belongs to this level: same name, rate and probes.
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

// In a window nobody wants to look on only: without --probe and without a probe of the level for it, the mouse gets
// one; not where there is a tool, which it takes hold of (window_carrier.h).
std::optional<ProbeSource> mouse_probe(const Level& level) {
  for (const LevelNode& node : level.nodes)
    if (node.handle || (node.device && node.device->driver == DriverKind::kMouse)) return {};
  std::string name = "mouse";
  const auto taken = [&](const LevelNode& node) { return node.name == name; };
  while (std::any_of(level.nodes.begin(), level.nodes.end(), taken)) name += "'";
  return ProbeSource{name, DriverKind::kMouse, {}};
}

// Probes that are not the level's: from --probe, from the recording, or one on a mesh that has none.
Outcome choose_probes(const RunOptions& options, bool windowed, Level& level, bool bare, Prepared& run,
                      std::vector<ProbeSource>& sources) {
  for (const std::string& argument : options.probes) {
    auto source = parse_source(argument);
    if (!source) return wrong_arguments(source.error());
    if (source->driver == DriverKind::kMouse && !windowed)
      return wrong_arguments({"--probe " + argument, "the mouse needs a window; leave out --headless, or use orbit"});
    sources.push_back(*source);
  }
  if (windowed && sources.empty())
    if (const std::optional<ProbeSource> mouse = mouse_probe(level)) sources.push_back(*mouse);
  std::vector<ProbeSource> added = sources;
  if (run.replay) {
    for (const std::string& name : run.replay->header.probes) {
      const auto has_name = [&](const LevelNode& node) { return node.name == name && (node.probe || node.handle); };
      if (std::none_of(level.nodes.begin(), level.nodes.end(), has_name))
        added.push_back({name, DriverKind::kExternal, {}});
    }
  } else if (bare && sources.empty()) {
    say(run,
        "the file has no probe, so one named `probe` touches it on the path `orbit`; --probe NAME=SOURCE gives others");
    sources = added = {{"probe", DriverKind::kOrbit, {}}};
  }
  if (const Status status = add_probes(level, added); !status) return wrong_arguments(status.error());
  return {};
}

// --tool-force stands above the key of every tool.
Outcome choose_tool_force(const RunOptions& options, Level& level) {
  bool any = false;
  for (LevelNode& node : level.nodes) {
    if (!node.handle) continue;
    node.handle->force = *value_of_word<ToolForce>(options.tool_force);  // the command line has checked it
    any = true;
  }
  if (any) return {};
  return wrong_arguments({"--tool-force", "is for tools, and the level has no PLIANT_handle; leave it out"});
}

// Where height fields live. `auto` goes by measured cost where there is a GPU and a display to refresh; lockstep stays
// on the processor, so that the same input gives the same bits everywhere.
FieldPlace choose_field(const RunOptions& options, bool windowed, const World& world) {
  if (options.field == "gpu") return FieldPlace::kGpu;
  if (options.field == "cpu" || !windowed) return FieldPlace::kProcessor;
  const Result<FieldCost> cost = measure_field_cost(world, 60.0);
  return cost && cost->gpu_us < cost->processor_us ? FieldPlace::kGpu : FieldPlace::kProcessor;
}

// Once, however many surfaces there are: which of them settle so slowly that they have another damping than their own.
void say_creeping(Prepared& run) {
  std::size_t more = 0;
  std::string sentence;
  for (auto [entity, deformable] : run.world.registry.view<const Deformable>()) {
    const double ratio = damping_of(deformable);
    if (!(ratio > deformable.damping_ratio)) continue;
    if (!sentence.empty()) {
      ++more;
      continue;
    }
    const Name* name = run.world.registry.find<Name>(entity);
    sentence = fmt::format(
        "`{}`: a surface that settles in {:g} s creeps and does not coast: damping_ratio {:.3g} is "
        "taken instead of {:g}; give a shorter settling_time to have your own",
        name ? name->value : std::string(), deformable.settling_time, ratio, deformable.damping_ratio);
  }
  if (more > 0) sentence += fmt::format(" ({} more surfaces too)", more);
  if (!sentence.empty()) say(run, sentence);
}

// Once, however many bodies there are: which of them lock.
void say_locking(Prepared& run) {
  std::size_t more = 0;
  std::string sentence;
  for (auto [entity, body] : run.world.registry.view<const SoftBody>()) {
    const std::string doubt = locking_doubt(body, run.world.tet_meshes[body.tets].tets.size());
    if (doubt.empty()) continue;
    const Name* name = run.world.registry.find<Name>(entity);
    if (sentence.empty())
      sentence = fmt::format("`{}` {}", name ? name->value : std::string(), doubt);
    else
      ++more;
  }
  if (more > 0) sentence += fmt::format(" ({} more bod{} too)", more, more == 1 ? "y" : "ies");
  if (!sentence.empty()) say(run, sentence);
}

}  // namespace

void say(Prepared& run, const std::string& sentence) {
  note(sentence);
  run.notes.push_back(sentence);
}

Outcome prepare(const RunOptions& options, bool windowed, Prepared& run) {
  if (!options.replay.empty()) {
    auto recording = read_recording(options.replay);
    if (!recording) return failed(recording.error());
    run.replay = std::move(recording).value();
  }
  const auto file = find_level(options.level);
  if (!file) return failed(file.error());
  auto loaded = load_level(*file);
  if (!loaded) return failed(loaded.error());
  Level& level = *loaded;
  std::vector<std::string> notes = level.notes;

  const bool bare = !level.has_pliant();
  if (options.unit != 1.0 && !bare)
    return wrong_arguments(
        {"--unit", "is for bare meshes; this level's PLIANT extensions name lengths in metres: scale its nodes"});
  scale_roots(level, options.unit);
  if (bare) {
    make_touchable(level);
    if (const std::string hint = unit_hint(bounds(level)); !hint.empty()) say(run, hint);
  }
  std::vector<ProbeSource> sources;
  if (Outcome wrong = choose_probes(options, windowed, level, bare, run, sources)) return wrong;
  SafetyCap cap;
  if (options.max_force > 0.0) cap.max_force = options.max_force;
  for (const std::string& sentence : cap_safety(level, cap)) say(run, sentence);
  if (const Status status = set_keys(level, options.sets); !status) return wrong_arguments(status.error());
  if (!options.tool_force.empty())
    if (Outcome wrong = choose_tool_force(options, level)) return wrong;
  if (run.replay) level.simulation.touch_rate = run.replay->header.rate;
  if (options.rate > 0.0) level.simulation.touch_rate = options.rate;

  auto spawned = spawn(level, &notes);
  if (!spawned) return failed(spawned.error());
  run.world = std::move(spawned).value();
  for (const std::string& sentence : notes) say(run, sentence);
  if (const Status status = apply_sources(run.world, sources); !status) return failed(status.error());
  if (windowed) repeat_scripts(run.world);
  run.world.field_place = choose_field(options, windowed, run.world);
  for (const auto prepare_system : {prepare_touch, prepare_tools, prepare_soft})
    if (const Status status = prepare_system(run.world); !status) return failed(status.error());
  for (const std::string& sentence : make_orbits(run.world)) say(run, sentence);
  if (const auto unfelt = unfelt_bodies(run.world)) say(run, *unfelt);
  say_creeping(run);
  say_locking(run);
  if (run.replay) {
    if (Outcome wrong = check_replay(*run.replay, options, run.world)) return wrong;
    if (run.replay->header.rate != run.world.simulation.touch_rate)
      return wrong_arguments(
          {"--rate", fmt::format("the recording was made at {} Hz; leave it out", run.replay->header.rate)});
  }
  return {};
}

}  // namespace pliant
