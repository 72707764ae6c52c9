// pliant run: a level or mesh, its probes, the loop, and what is written about it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "content/file_io.h"
#include "content/level.h"
#include "player/content_folder.h"
#include "player/exit.h"
#include "player/frames.h"
#include "player/journal.h"
#include "player/keeper.h"
#include "player/output_folder.h"
#include "player/plot.h"
#include "player/recording.h"
#include "player/report.h"
#include "player/sources.h"
#include "player/touch_loop.h"
#include "player/verbs.h"
#include "player/window_session.h"
#include "runtime/parallel.h"
#include "systems/device/hands.h"
#include "systems/schedule.h"
#include "systems/tool/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/tool/soft_state.h"
#include "systems/touch/hash_state.h"
#include "systems/touch/prepare.h"
#include "systems/visual/field_cost.h"

namespace pliant {
namespace {

constexpr double kDefaultSeconds = 4.0;   // [s] without a script
constexpr double kLongestDefault = 60.0;  // [s] of a script, unless --seconds asks for more
constexpr double kJournalSeconds = 8.0;   // [s] of rows that may wait while a picture is drawn and written
constexpr int kDefaultFrames = 12;
constexpr int kWindowWidth = 1280, kWindowHeight = 720;  // [pixel]
constexpr double kEndless = 1e7;                         // [s] a window stays open until it is closed

// What could not be done, and whether the arguments or the input are to blame.
struct Failure {
  ExitStatus status;
  Error error;
};
using Outcome = std::optional<Failure>;

Outcome wrong_arguments(Error error) {
  return Failure{kUsage, std::move(error)};
}
Outcome failed(Error error) {
  return Failure{kFailed, std::move(error)};
}

Outcome check(const RunOptions& options) {
  if (options.field == "gpu" && options.frames == 0)
    return wrong_arguments({"--field gpu", "computes the surface for pictures; leave out --frames 0"});
  if (!options.replay.empty() && options.realtime)
    return wrong_arguments({"--replay", "runs in lockstep; leave out --realtime"});
  if (!options.replay.empty() && !options.probes.empty())
    return wrong_arguments({"--replay", "moves every probe itself; leave out --probe"});
  if (!options.replay.empty() && options.window)
    return wrong_arguments({"--replay", "runs in lockstep, which a window does not; leave out --window"});
  return {};
}

// Everything a run needs before its first tick.
struct Prepared {
  RunOptions options;
  World world;
  std::optional<Recording> replay;
  std::vector<std::string> notes;
};

// A window and what is to be shown in it.
struct Shown {
  std::unique_ptr<Window> window;
  InputScript script;
};

void say(Prepared& run, const std::string& sentence) {
  note(sentence);
  run.notes.push_back(sentence);
}

// The recording belongs to this level: same name, rate and probes.
Outcome check_replay(const Recording& replay, const RunOptions& options, const World& world) {
  const Error other{options.replay, ""};
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
// one; not where there is a tool, which --probe TOOL=mouse gives to it.
std::optional<ProbeSource> mouse_probe(const Level& level) {
  for (const LevelNode& node : level.nodes)
    if (node.handle || (node.device && node.device->driver == Driver::kMouse)) return {};
  std::string name = "mouse";
  const auto taken = [&](const LevelNode& node) { return node.name == name; };
  while (std::any_of(level.nodes.begin(), level.nodes.end(), taken)) name += "'";
  return ProbeSource{name, Driver::kMouse, {}};
}

// Probes that are not the level's: from --probe, from the recording, or one on a mesh that has none.
Outcome choose_probes(const RunOptions& options, bool windowed, Level& level, bool bare, Prepared& run,
                      std::vector<ProbeSource>& sources) {
  for (const std::string& argument : options.probes) {
    auto source = parse_source(argument);
    if (!source) return wrong_arguments(source.error());
    if (source->driver == Driver::kMouse && !windowed)
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
        added.push_back({name, Driver::kExternal, {}});
    }
  } else if (bare && sources.empty()) {
    say(run,
        "the file has no probe, so one named `probe` touches it on the path `orbit`; --probe NAME=SOURCE gives others");
    sources = added = {{"probe", Driver::kOrbit, {}}};
  }
  if (const Status status = add_probes(level, added); !status) return wrong_arguments(status.error());
  return {};
}

// Where height fields live. `auto` goes by measured cost where there is a card and a display to refresh; lockstep stays
// on the processor, so that the same input gives the same bits everywhere.
FieldPlace choose_field(const RunOptions& options, bool windowed, const World& world) {
  if (options.field == "gpu") return FieldPlace::kCard;
  if (options.field == "cpu" || !windowed) return FieldPlace::kProcessor;
  const Result<FieldCost> cost = measure_field_cost(world, 60.0);
  return cost && cost->card_us < cost->processor_us ? FieldPlace::kCard : FieldPlace::kProcessor;
}

// File -> Level -> World, ready to be touched.
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
  for (const std::string& sentence : level.notes) run.notes.push_back(sentence);

  const bool bare = !level.has_pliant();
  if (bare) make_touchable(level);
  std::vector<ProbeSource> sources;
  if (Outcome wrong = choose_probes(options, windowed, level, bare, run, sources)) return wrong;
  for (const std::string& assignment : options.sets)
    if (const Status status = set_key(level, assignment); !status) return wrong_arguments(status.error());
  if (run.replay) level.simulation.touch_rate = run.replay->header.rate;
  if (options.rate > 0.0) level.simulation.touch_rate = options.rate;

  auto spawned = spawn(level);
  if (!spawned) return failed(spawned.error());
  run.world = std::move(spawned).value();
  if (const Status status = apply_sources(run.world, sources); !status) return failed(status.error());
  run.world.field_place = choose_field(options, windowed, run.world);
  for (const auto prepare_system : {prepare_touch, prepare_tools, prepare_soft})
    if (const Status status = prepare_system(run.world); !status) return failed(status.error());
  for (const std::string& sentence : make_orbits(run.world)) say(run, sentence);
  if (run.replay) {
    if (Outcome wrong = check_replay(*run.replay, options, run.world)) return wrong;
    if (run.replay->header.rate != run.world.simulation.touch_rate)
      return wrong_arguments(
          {"--rate", fmt::format("the recording was made at {} Hz; leave it out", run.replay->header.rate)});
  }
  return {};
}

// As long as the longest script that a probe or tool follows.
double default_seconds(const World& world) {
  double longest = 0.0;
  for (const Entity hand : hands(world)) {
    const HapticDevice* device = find_device(world, hand);
    if (!device || device->driver != Driver::kScript || !device->path.valid()) continue;
    const Path& path = world.paths[device->path];
    if (!path.rows.empty()) longest = std::max(longest, path.rows.back().time);
  }
  return longest > 0.0 ? std::min(longest, kLongestDefault) : kDefaultSeconds;
}

std::uint64_t count_ticks(const RunOptions& options, bool windowed, const Prepared& run) {
  const double rate = run.world.simulation.touch_rate;
  if (windowed)
    return static_cast<std::uint64_t>(std::llround((options.seconds > 0.0 ? options.seconds : kEndless) * rate));
  const bool all = run.replay && options.seconds <= 0.0;
  const double seconds = options.seconds > 0.0 ? options.seconds : default_seconds(run.world);
  const auto wanted = static_cast<std::uint64_t>(std::max<long long>(1, std::llround(seconds * rate)));
  const std::uint64_t recorded = run.replay ? run.replay->ticks.size() : wanted;
  return all ? recorded : std::min(wanted, recorded);
}

// A window where there is a display, unless that was forbidden or what is asked for needs virtual time. Without one,
// only an order to have one is a failure.
Outcome open_window(const RunOptions& options, Shown& shown) {
  const bool possible = !options.headless && !options.lockstep && options.replay.empty();
  if (!options.window && (!possible || !Window::display_is_there())) {
    if (!options.input.empty()) return wrong_arguments({"--input", "is for a window; leave out --headless"});
    return {};
  }
  if (!options.input.empty()) {
    auto script = InputScript::load(options.input);
    if (!script) return failed(script.error());
    shown.script = std::move(script).value();
  }
  auto window =
      Window::create(options.sized ? options.width : kWindowWidth, options.sized ? options.height : kWindowHeight);
  if (!window) {
    if (options.window) return failed(window.error());
    note(window.error().what + " (going on without a window)");
    return {};
  }
  if (options.frames > 0 && options.seconds <= 0.0)
    return wrong_arguments({"--frames", "spreads pictures over a duration; give --seconds, or use --fps"});
  shown.window = std::move(window).value();
  return {};
}

// Without a working graphics library, pictures that nobody asked for are left out with a note.
Outcome make_frames(const RunOptions& options, Prepared& run, std::unique_ptr<Frames>& frames) {
  const bool asked = options.frames >= 0 || options.fps > 0.0;
  if (options.frames == 0) return {};
  auto made = Frames::create(run.world, options.width, options.height);
  if (made) {
    frames = std::move(made).value();
  } else if (asked) {
    return failed(made.error());
  } else {
    say(run, made.error().message() + " (going on without pictures)");
  }
  return {};
}

Outcome write_reports(const RunFigures& figures, OutputFolder& out) {
  std::vector<PlotRow> rows;
  for (std::size_t i = 0; i < figures.keeper.summaries().size(); ++i)
    rows.push_back(
        {figures.keeper.summaries()[i].name, figures.keeper.summaries()[i].source, &figures.keeper.traces()[i]});
  const double dt = 1.0 / figures.rate;
  const double seconds = static_cast<double>(figures.journal.ticks() + figures.overruns) * dt;
  if (const Status plotted = plot_forces(out.stage("forces.png"), figures.world.name, rows, dt, seconds); !plotted)
    return failed(plotted.error());
  const std::string json = report_json(figures);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(json.data());
  if (const Status written = write_file(out.stage("report.json"), std::span(bytes, json.size())); !written)
    return failed(written.error());
  if (const Status done = out.commit(); !done) return failed(done.error());
  return {};
}

// Options for a file that was dropped: what was said of the first level's nodes and files is not meant for it.
RunOptions another_level(const RunOptions& options, const std::string& file) {
  RunOptions other = options;
  other.level = file;
  other.probes.clear();
  other.sets.clear();
  other.record.clear();
  if (!options.out.empty()) other.out = options.out + "/" + std::filesystem::path(file).stem().string();
  return other;
}

// What a run was like, whichever clock it ran on.
struct Ran {
  std::string mode;
  std::uint64_t overruns = 0;
  std::optional<FrameFigures> drawn;
  std::size_t pictures = 0;
  bool opened = false;  // another level takes its place
};

Result<Ran> run_headless(const RunOptions& options, TouchLoop& loop) {
  Ran ran{options.realtime ? "realtime" : "lockstep"};
  const Status status = options.realtime ? run_realtime(loop, ran.overruns) : run_lockstep(loop);
  if (!status) return status.error();
  if (loop.frames) {
    ran.drawn = loop.frames->figures();
    ran.pictures = loop.frames->count();
  }
  return ran;
}

Result<Ran> run_shown(const RunOptions& options, Shown& shown, TouchLoop& loop, Prepared& next) {
  WindowSession session{*shown.window, shown.script, loop.world, loop.schedule,
                        loop.journal,  loop.keeper,  loop.out,   loop.interrupt};
  session.soft = loop.soft;
  session.level = options.level;
  session.rate = loop.rate;
  session.ticks = loop.ticks;
  session.frame_width = options.width;
  session.frame_height = options.height;
  if (options.fps > 0.0) session.frame_ticks = regular_frames(loop.ticks, loop.rate, options.fps);
  if (options.frames > 0) session.frame_ticks = spread_frames(loop.ticks, options.frames);
  // Measuring needs the context, which is this thread's: what was chosen for the first level holds for the next.
  const std::string field = loop.world.field_place == FieldPlace::kCard ? "gpu" : "cpu";
  session.open = [&options, &next, field](const std::string& file) -> std::optional<Error> {
    next = Prepared();
    RunOptions other = options;
    if (file != options.level) other = another_level(options, file);
    other.field = field;
    if (Outcome wrong = prepare(other, true, next)) return wrong->error;
    next.options = other;
    return {};
  };
  auto figures = run_window(session);
  if (!figures) return figures.error();
  return Ran{"window", figures->overruns, figures->frames, figures->pictures, figures->opened};
}

// `shown`: the window, or null. `next`: what is to be run after this, if a window asked for it.
Outcome run_prepared(const RunOptions& options, Prepared& run, Shown* shown, std::optional<Prepared>& next) {
  World& world = run.world;
  const double rate = world.simulation.touch_rate;
  const std::uint64_t ticks = count_ticks(options, shown, run);

  const Interrupt interrupt;  // until all is in place: what is staged must not stay behind
  auto out = OutputFolder::create(options.out.empty() ? "out/" + world.name : options.out);
  if (!out) return failed(out.error());
  Journal journal(world, options.realtime || shown ? kJournalSeconds : 2.0 / rate);
  std::vector<std::string> sources;
  for (Entity probe : journal.probes())
    sources.push_back(run.replay ? "replay:" + options.replay : describe_source(world, probe));
  auto keeper = Keeper::create(world, journal.probes(), sources, out->stage("forces.csv"));
  if (!keeper) return failed(keeper.error());
  if (journal.probes().empty())
    say(run, "the level has no probe and no tool, so nothing is touched; give one with --probe NAME=orbit");
  if (!options.record.empty()) {
    RecordingHeader header{world.name, rate, {}};
    for (const ProbeSummary& probe : keeper->summaries()) header.probes.push_back(probe.name);
    auto writer = RecordingWriter::create(options.record, header);
    if (!writer) return failed(writer.error());
    keeper->record_to(std::move(writer).value());
  }
  std::unique_ptr<Frames> frames;
  if (!shown)
    if (Outcome wrong = make_frames(options, run, frames)) return wrong;

  Schedule<World> schedule(touch_schedule());
  TouchLoop loop{world, schedule, journal, *keeper, *out, interrupt, rate, ticks, frames.get(), {}, nullptr};
  loop.replay = run.replay ? &*run.replay : nullptr;
  if (options.realtime || shown) limit_tool_ticks(world);
  SoftClock soft(world);
  if (soft.any()) loop.soft = &soft;
  if (frames)
    loop.frame_ticks = options.fps > 0.0 ? regular_frames(ticks, rate, options.fps)
                                         : spread_frames(ticks, options.frames < 0 ? kDefaultFrames : options.frames);
  Prepared other;
  auto ran = shown ? run_shown(options, *shown, loop, other) : run_headless(options, loop);
  if (!ran) return failed(ran.error());
  if (ran->opened) next = std::move(other);
  if (soft.any()) world.dropped |= world.soft->dropped;
  Hash hash = journal.hash();
  hash_state(world, hash);
  release_devices(world);
  if (const Status kept = keeper->finish(); !kept) return failed(kept.error());

  RunFigures figures{world,
                     schedule,
                     journal,
                     *keeper,
                     ran->drawn ? &*ran->drawn : nullptr,
                     ran->pictures,
                     ran->mode,
                     world.field_place == FieldPlace::kCard ? "gpu" : "cpu",
                     rate,
                     ran->overruns,
                     explain_dropped(world.dropped),
                     fmt::format("{:016x}", hash.value()),
                     loop.soft};
  if (journal.lost() > 0)
    figures.dropped.push_back(
        fmt::format("{} rows of forces.csv were lost because writing fell behind: take fewer or "
                    "smaller pictures",
                    journal.lost()));
  figures.dropped.insert(figures.dropped.end(), run.notes.begin(), run.notes.end());
  if (Outcome wrong = write_reports(figures, *out)) return wrong;
  print_summary(figures, options.out.empty() ? "out/" + world.name : options.out);
  return {};
}

}  // namespace

int run(const RunOptions& options) {
  set_thread_count(options.threads);
  if (Outcome wrong = check(options)) return fail(wrong->status, wrong->error);
  Shown shown;
  if (Outcome wrong = open_window(options, shown)) return fail(wrong->status, wrong->error);
  const bool windowed = shown.window != nullptr;
  std::optional<Prepared> next(std::in_place);
  next->options = options;
  Outcome wrong = prepare(options, windowed, *next);
  while (!wrong && next) {
    Prepared now = std::move(*next);
    next.reset();
    wrong = run_prepared(now.options, now, windowed ? &shown : nullptr, next);
  }
  return wrong ? fail(wrong->status, wrong->error) : kDone;
}

}  // namespace pliant
