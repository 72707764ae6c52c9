#include "player/level/run_setup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

#include "content/device_answers.h"
#include "content/keys/enum_words.h"
#include "content/keys/extension_table.h"
#include "content/keys/sliders.h"
#include "content/keys/sliders.h"
#include "content/keys/unused_keys.h"
#include "content/level/probe_damage.h"
#include "content/level/spawn_soft.h"
#include "content/level/unfelt_relief.h"
#include "content/level/unit.h"
#include "content/level_file.h"
#include "content/safety_cap.h"
#include "engine/choice/model_choice.h"
#include "engine/run/driver_limits.h"
#include "engine/run/sources.h"
#include "lab/files/content_folder.h"
#include "player/level/run_replay.h"
#include "player/run/unfelt.h"
#include "systems/device/hands.h"
#include "systems/device/repeat.h"
#include "systems/prepare_world.h"
#include "systems/soft/under_gravity.h"
#include "systems/touch/model/local_model.h"
#include "systems/touch/prepare/nested.h"
#include "systems/visual/field_cost.h"

namespace pliant {
namespace {

constexpr const char* kNeedsWindow =
    "needs a window, and none is open; set DISPLAY and leave out --headless and --lockstep, or use orbit";
constexpr const char *kUnitSetting = "--unit=", *kErrorSetting = "--error=";  // in a recording's settings

// The default probe of a window: without --probe and without a mouse probe in the level, the mouse gets one. Not if
// there is a tool, which the mouse carries instead (viewer/hand/carrier.h).
std::optional<ProbeSource> mouse_probe(const Level& level) {
  for (const LevelNode& node : level.nodes)
    if (node.handle || (node.device && node.device->driver == DriverKind::kMouse)) return {};
  std::string name = "mouse";
  const auto taken = [&](const LevelNode& node) { return node.name == name; };
  while (std::any_of(level.nodes.begin(), level.nodes.end(), taken)) name += "'";
  return ProbeSource{name, DriverKind::kMouse, {}};
}

// A name that is not in the level creates a new probe, on purpose or by a misspelling: a note tells the user.
void say_added(const RunOptions& options, const Level& level, Prepared& run) {
  std::vector<std::string> names;
  for (const LevelNode& node : level.nodes)
    if (node.probe || node.handle) names.push_back(node.name);
  for (const std::string& argument : options.probes) {
    const std::string name = argument.substr(0, argument.find('='));
    if (names.empty() || std::find(names.begin(), names.end(), name) != names.end()) continue;
    const std::string near = suggestion(name, names);
    say(run, Note{fmt::format("--probe {}: the level has no probe or tool of that name, so one was added", name),
                  near.empty() ? fmt::format("it has: {}", fmt::join(names, ", ")) : near, "run.probe_added", name});
  }
}

// Adds probes that are not in the level: from --probe, from the recording, or one for a bare mesh.
Outcome choose_probes(const RunOptions& options, bool windowed, Level& level, bool bare, Prepared& run,
                      std::vector<ProbeSource>& sources) {
  for (const std::string& argument : options.probes) {
    auto source = parse_source(argument);
    if (!source) return wrong_arguments(source.error());
    if (source->driver == DriverKind::kMouse && !windowed)
      return wrong_arguments({"--probe " + argument, kNeedsWindow});
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
  if (!bare && !run.replay) say_added(options, level, run);
  const std::size_t own = level.nodes.size();
  if (const Status status = add_probes(level, added); !status) return wrong_arguments(status.error());
  // A recording stores only the names of added probes, and a replay adds points: their radius is stored as a setting.
  for (std::size_t n = own; n < level.nodes.size() && !run.replay; ++n)
    if (const LevelNode& node = level.nodes[n]; node.probe && node.probe->radius > 0.0)
      run.settings.push_back(fmt::format("{}.probe.radius={}", node.name, node.probe->radius));
  return {};
}

// Device requests of the level that are not permitted are removed, unless the user decided otherwise: by --probe, by a
// stored answer for this file, or afterwards by --set.
void hold_back_requests(const RunOptions& options, Level& level, Prepared& run) {
  const DeviceAnswers answers = DeviceAnswers::load();
  for (LevelRequest& asked : device_requests(level)) {
    if (asked.request.refused.empty() || answers.allows(run.file, asked.id)) continue;
    level.nodes[asked.node].device->id = asked.request.allowed;
    const bool named = std::any_of(options.probes.begin(), options.probes.end(), [&](const std::string& argument) {
      return argument.starts_with(asked.moves + "=");
    });
    if (!named) run.refused.push_back(std::move(asked));
  }
}

// If a hand is left without a source, that is an error, or in a window a question.
Outcome refuse_requests(bool windowed, const Level& level, Prepared& run) {
  std::erase_if(run.refused, [&](const LevelRequest& asked) {
    const HapticDevice& device = *level.nodes[asked.node].device;
    return device.driver != DriverKind::kExternal || device.id != asked.request.allowed;
  });
  for (const LevelRequest& asked : run.refused) {
    const std::string where = "`" + asked.moves + "`", code = "device.refused";
    const std::string what =
        "the level asks for more than it may: " + fmt::format("{}", fmt::join(asked.request.refused, "; "));
    if (asked.request.allowed.empty() && !windowed) return failed({where, what, device_cure(asked), code});
    say(run, Note{where + ": " + what, windowed ? "the window asks you" : device_cure(asked), code, asked.moves});
  }
  return {};
}

// --tool-force overrides the key of every tool.
Outcome choose_tool_force(const RunOptions& options, Level& level) {
  bool any = false;
  for (LevelNode& node : level.nodes) {
    if (!node.handle) continue;
    node.handle->force = *value_of_word<ToolForce>(options.tool_force);  // validated by the command line
    any = true;
  }
  if (any) return {};
  return wrong_arguments({"--tool-force", "is for tools, and the level has no PLIANT_handle; leave it out"});
}

// Chooses where height fields are computed. `auto` uses measured cost if there are a GPU and a display to refresh.
// Lockstep stays on the CPU, so that the same input gives the same bits everywhere.
FieldPlace choose_field(const RunOptions& options, bool windowed, const World& world) {
  if (options.field == "gpu") return FieldPlace::kGpu;
  if (options.field == "cpu" || !windowed) return FieldPlace::kProcessor;
  const Result<FieldCost> cost = measure_field_cost(world, 60.0);
  return cost && cost->gpu_us < cost->processor_us ? FieldPlace::kGpu : FieldPlace::kProcessor;
}

// Notes devices of the level whose driver is absent in this run.
void say_unmoved(bool windowed, Prepared& run) {
  if (run.replay) return;
  for (const Entity hand : hands(run.world)) {
    const HapticDevice* device = find_device(run.world, hand);
    if (!device) continue;
    if (device->driver == DriverKind::kExternal && !device->id.empty())
      continue;  // opened right before the clocks start
    if (device->driver == DriverKind::kExternal && !run.refused.empty()) continue;  // already reported
    const bool mouse = device->driver == DriverKind::kMouse && !windowed;
    if (!mouse && (device->driver != DriverKind::kExternal || run.hands.moves(hand))) continue;
    const Name* name = run.world.registry.find<Name>(hand);
    const std::string its = name ? name->value : std::string();
    say(run, Note{fmt::format("nothing moves `{}`: its driver `{}` {}", its, word_of(device->driver),
                              mouse ? "needs a window" : "is for programs that embed the engine"),
                  moving_cure(run.world, its), "run.unmoved", its});
  }
}

// One mouse moves one probe: the one named by --probe, else the first. Two would be at the same place.
void keep_one_mouse(const std::vector<ProbeSource>& sources, Prepared& run) {
  std::vector<std::pair<std::string, HapticDevice*>> moved;
  for (const Entity hand : hands(run.world)) {
    if (!find_device(run.world, hand)) continue;
    HapticDevice& device = run.world.registry.get<HapticDevice>(device_of(run.world, hand));
    const Name* name = run.world.registry.find<Name>(hand);
    if (device.driver == DriverKind::kMouse) moved.emplace_back(name ? name->value : std::string(), &device);
  }
  std::stable_partition(moved.begin(), moved.end(), [&](const auto& each) {
    return std::any_of(sources.begin(), sources.end(), [&](const ProbeSource& source) {
      return source.driver == DriverKind::kMouse && source.name == each.first;
    });
  });
  for (std::size_t i = 1; i < moved.size(); ++i) {
    moved[i].second->driver = DriverKind::kExternal;
    say(run,
        Note{fmt::format("there is one mouse, and it moves `{}`; nothing moves `{}`", moved[0].first, moved[i].first),
             moving_cure(run.world, moved[i].first), "run.unmoved", moved[i].first});
  }
}

// One note for all surfaces that settle so slowly that their damping was changed.
void say_creeping(Prepared& run) {
  std::size_t more = 0;
  std::optional<Note> found;
  for (auto [entity, deformable] : run.world.registry.view<const Deformable>()) {
    const double ratio = damping_of(deformable);
    if (!(ratio > deformable.damping_ratio)) continue;
    if (found) {
      ++more;
      continue;
    }
    const Name* name = run.world.registry.find<Name>(entity);
    const std::string its = name ? name->value : std::string();
    found = Note{fmt::format("`{}`: settling_time {:g} s needs damping_ratio {:.3g}, which is used instead of {:g}",
                             its, deformable.settling_time, ratio, deformable.damping_ratio),
                 "give a shorter settling_time to keep your own", "surface.creeps", its};
  }
  if (more > 0) found->cure += fmt::format(" ({} more surfaces too)", more);
  if (found) say(run, *found);
}

// --error of this run, else of the recording.
Outcome apply_budget(const RunOptions& options, Level& level, Prepared& run) {
  double budget = options.error;
  if (run.replay && !(budget > 0.0))
    for (const std::string& setting : run.replay->header.settings) {
      if (!setting.starts_with(kErrorSetting)) continue;
      const std::string text = setting.substr(std::string_view(kErrorSetting).size());
      char* end = nullptr;
      budget = std::strtod(text.c_str(), &end);
      if (text.empty() || *end != '\0' || !(budget >= kErrorBudget.min && budget <= kErrorBudget.max))
        return failed({options.replay, "its setting " + setting + " is no error budget; record it again"});
      say(run, "the recording's error budget holds: " + setting);
    }
  if (!(budget > 0.0)) return {};
  if (const Status set = set_error_budget(level, budget); !set) return wrong_arguments(set.error());
  run.settings.push_back(fmt::format("{}{}", kErrorSetting, budget));
  return {};
}

// A replay uses its recorded settings, then --set and --tool-force.
Outcome apply_settings(const RunOptions& options, std::optional<double> unit, Level& level, Prepared& run) {
  if (run.replay && !run.replay->header.settings.empty()) {
    for (const std::string& setting : run.replay->header.settings)
      if (!setting.starts_with(kUnitSetting) && !setting.starts_with(kErrorSetting) && !is_driver_setting(setting))
        run.settings.push_back(setting);
    if (const Status status = set_keys(level, run.settings); !status)
      return failed({options.replay, "its setting " + status.error().message() + "; record it again with this level"});
    if (unit != options.unit || !run.settings.empty())
      say(run, fmt::format("the recording's settings hold:{}{}{}",
                           unit != options.unit ? fmt::format(" --unit {}", *unit) : std::string(),
                           run.settings.empty() ? "" : " --set ", fmt::join(run.settings, " --set ")));
  }
  if (const Status status = set_keys(level, options.sets); !status) return wrong_arguments(status.error());
  run.settings.insert(run.settings.end(), options.sets.begin(), options.sets.end());
  if (!options.tool_force.empty()) {
    if (Outcome wrong = choose_tool_force(options, level)) return wrong;
    run.settings.push_back("*.handle.force=" + options.tool_force);
  }
  if (unit) run.settings.push_back(fmt::format("{}{}", kUnitSetting, *unit));
  return {};
}

// A bare mesh is replayed in its recorded unit, unless --unit gives another. Empty: none is said.
Result<std::optional<double>> choose_unit(const RunOptions& options, const Level& level, const Prepared& run) {
  if (const Status status = check_unit(level, options.unit); !status) return status.error();
  std::optional<double> unit = options.unit;
  if (run.replay && !unit && !level.has_pliant())
    for (const std::string& setting : run.replay->header.settings) {
      if (!setting.starts_with(kUnitSetting)) continue;
      const Result<double> recorded = parse_unit(setting.substr(std::string_view(kUnitSetting).size()));
      if (!recorded) return recorded.error();
      unit = *recorded;
    }
  if (const Status said = check_unit_said(level, unit); !said) return said.error();
  return unit;
}

// One note for all bodies with locking elements.
void say_locking(Prepared& run) {
  std::size_t more = 0;
  std::optional<Note> found;
  for (auto [entity, body] : run.world.registry.view<const SoftBody>()) {
    std::optional<Note> doubt = locking_doubt(body, run.world.tet_meshes[body.tets].tets.size());
    if (!doubt) continue;
    if (found) {
      ++more;
      continue;
    }
    const Name* name = run.world.registry.find<Name>(entity);
    doubt->of = name ? name->value : std::string();
    doubt->what = "`" + doubt->of + "` " + doubt->what;
    found = std::move(doubt);
  }
  if (more > 0) found->cure += fmt::format(" ({} more bod{} too)", more, more == 1 ? "y" : "ies");
  if (found) say(run, *found);
}

// The level as the run uses it: unit, probes, limits, settings, budget, models.
Outcome prepare_level(const RunOptions& options, bool windowed, Level& level, std::vector<ProbeSource>& sources,
                      Prepared& run) {
  const bool bare = !level.has_pliant();
  const Result<std::optional<double>> unit = choose_unit(options, level, run);
  if (!unit) return unit.error().code == kUnitUnsaid ? failed(unit.error()) : wrong_arguments(unit.error());
  scale_roots(level, unit->value_or(1.0));
  if (bare) {
    make_touchable(level);
    if (const std::string hint = unit_hint(bounds(level)); !hint.empty()) say(run, hint);
  }
  if (!run.replay) hold_back_requests(options, level, run);
  if (Outcome wrong = choose_probes(options, windowed, level, bare, run, sources)) return wrong;
  SafetyCap cap;
  if (options.max_force > 0.0) cap.max_force = options.max_force;
  for (const std::string& sentence : cap_safety(level, cap)) say(run, Note{sentence, {}, "device.capped", {}});
  if (Outcome wrong = apply_settings(options, *unit, level, run)) return wrong;
  if (Outcome wrong = refuse_requests(windowed, level, run)) return wrong;
  // Budgets are measured at the run's rate.
  if (run.replay) level.simulation.touch_rate = run.replay->header.rate;
  if (options.rate > 0.0) level.simulation.touch_rate = options.rate;
  if (Outcome wrong = apply_budget(options, level, run)) return wrong;
  const auto sliders = sliders_of(level);  // --set may have changed what they set
  if (!sliders) return failed(sliders.error());
  run.sliders = *sliders;
  const auto choices = choose_models(level);
  if (!choices) return failed(choices.error());
  for (const ModelChoice& choice : *choices) say(run, choice.sentence());
  return {};
}

Outcome make_world(const RunOptions& options, bool windowed, Level& level, std::vector<std::string> notes,
                   const std::vector<ProbeSource>& sources, Prepared& run) {
  auto spawned = spawn_moving_images(level, &notes);
  if (!spawned) return failed(spawned.error());
  run.world = std::move(spawned).value();
  for (const std::string& sentence : notes) say(run, Note{sentence, {}, "level.note", {}});
  for (const Note& unused : unused_key_notes(level)) say(run, unused);
  for (const std::optional<Note>& note : {unfelt_relief(level), undamaged_by_bodies(level)})
    if (note) say(run, *note);
  if (const Status status = apply_sources(run.world, sources); !status) return failed(status.error());
  if (windowed) repeat_scripts(run.world);
  run.world.field_place = choose_field(options, windowed, run.world);
  const std::vector<Note> found = tissue_findings(run.world);
  if (const Status status = prepare_world(run.world); !status) return failed(status.error());
  for (const Note& note : tissue_findings(run.world))
    if (std::find(found.begin(), found.end(), note) == found.end()) say(run, note);
  for (const std::string& sentence : make_orbits(run.world)) say(run, sentence);
  auto held = make_hands(run.world, sources);
  if (!held) return wrong_arguments(held.error());
  run.hands = std::move(held).value();
  for (const std::string& sentence : run.hands.notes()) say(run, sentence);
  say_unmoved(windowed, run);
  if (windowed) keep_one_mouse(sources, run);
  if (const auto unfelt = unfelt_bodies(run.world)) say(run, *unfelt);
  for (const Note& nested : explain_nested(run.world)) say(run, nested);
  say_creeping(run);
  say_locking(run);
  return {};
}

}  // namespace

void say(Prepared& run, const Note& said) {
  note(said.message());
  run.notes.push_back(said);
}
void say(Prepared& run, const std::string& sentence) {
  say(run, Note{sentence, {}, "run.note", {}});
}

Outcome prepare(const RunOptions& options, bool windowed, Prepared& run) {
  if (!options.replay.empty())
    if (Outcome wrong = load_replay(options, run)) return wrong;
  const auto file = find_level(options.level);
  if (!file) return failed(file.error());
  auto level = load_level(*file);
  if (!level) return failed(level.error());
  run.file = *file;
  std::vector<std::string> notes = level->notes;
  std::vector<ProbeSource> sources;
  if (Outcome wrong = prepare_level(options, windowed, *level, sources, run)) return wrong;
  compare_scene(options, *level, run);
  if (Outcome wrong = make_world(options, windowed, *level, std::move(notes), sources, run)) return wrong;
  return run.replay ? apply_replay(options, run) : Outcome{};
}

}  // namespace pliant
