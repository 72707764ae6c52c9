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
#include "runtime/parallel.h"
#include "systems/schedule.h"
#include "systems/touch/hash_state.h"
#include "systems/touch/prepare.h"

namespace pliant {
namespace {

constexpr double kDefaultSeconds = 4.0;    // [s] without a script
constexpr double kLongestDefault = 60.0;   // [s] of a script, unless --seconds asks for more
constexpr double kJournalSeconds = 8.0;    // [s] of rows that may wait while a picture is drawn and written
constexpr int kDefaultFrames = 12;

// What could not be done, and whether the arguments or the input are to blame.
struct Failure {
  ExitStatus status;
  Error error;
};
using Outcome = std::optional<Failure>;

Outcome wrong_arguments(Error error) { return Failure{kUsage, std::move(error)}; }
Outcome failed(Error error) { return Failure{kFailed, std::move(error)}; }

Outcome check(const RunOptions& options) {
  if (options.window) return wrong_arguments({"--window", "not yet built; use --headless"});
  if (options.field == "gpu") return wrong_arguments({"--field gpu", "not yet built; use cpu or auto"});
  if (!options.replay.empty() && options.realtime)
    return wrong_arguments({"--replay", "runs in lockstep; leave out --realtime"});
  if (!options.replay.empty() && !options.probes.empty())
    return wrong_arguments({"--replay", "moves every probe itself; leave out --probe"});
  return {};
}

// Everything a run needs before its first tick.
struct Prepared {
  World world;
  std::optional<Recording> replay;
  std::vector<std::string> notes;
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
  for (auto [entity, probe] : world.registry.view<Probe>()) {
    const Name* name = world.registry.find<Name>(entity);
    names.push_back(name ? name->value : std::string());
  }
  if (names != replay.header.probes)
    return failed({options.replay, "was recorded with other probes than the level has; record it again"});
  return {};
}

// Probes that are not the level's: from --probe, from the recording, or one on a mesh that has none.
Outcome choose_probes(const RunOptions& options, Level& level, bool bare, Prepared& run,
                      std::vector<ProbeSource>& sources) {
  for (const std::string& argument : options.probes) {
    auto source = parse_source(argument);
    if (!source) return wrong_arguments(source.error());
    sources.push_back(*source);
  }
  std::vector<ProbeSource> added = sources;
  if (run.replay) {
    for (const std::string& name : run.replay->header.probes) {
      const auto has_name = [&](const LevelNode& node) { return node.name == name && node.probe.has_value(); };
      if (std::none_of(level.nodes.begin(), level.nodes.end(), has_name)) added.push_back({name, Driver::kExternal, {}});
    }
  } else if (bare && sources.empty()) {
    say(run, "the file has no probe, so one named `probe` touches it on the path `orbit`; --probe NAME=SOURCE gives others");
    sources = added = {{"probe", Driver::kOrbit, {}}};
  }
  if (const Status status = add_probes(level, added); !status) return wrong_arguments(status.error());
  return {};
}

// File -> Level -> World, ready to be touched.
Outcome prepare(const RunOptions& options, Prepared& run) {
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
  if (Outcome wrong = choose_probes(options, level, bare, run, sources)) return wrong;
  for (const std::string& assignment : options.sets)
    if (const Status status = set_key(level, assignment); !status) return wrong_arguments(status.error());
  if (run.replay) level.simulation.touch_rate = run.replay->header.rate;
  if (options.rate > 0.0) level.simulation.touch_rate = options.rate;

  auto spawned = spawn(level);
  if (!spawned) return failed(spawned.error());
  run.world = std::move(spawned).value();
  if (const Status status = apply_sources(run.world, sources); !status) return failed(status.error());
  if (const Status status = prepare_touch(run.world); !status) return failed(status.error());
  make_orbits(run.world);
  if (run.replay) {
    if (Outcome wrong = check_replay(*run.replay, options, run.world)) return wrong;
    if (run.replay->header.rate != run.world.simulation.touch_rate)
      return wrong_arguments({"--rate", fmt::format("the recording was made at {} Hz; leave it out", run.replay->header.rate)});
  }
  return {};
}

// As long as the longest script that a probe follows.
double default_seconds(const World& world) {
  double longest = 0.0;
  for (auto [entity, probe] : world.registry.view<Probe>()) {
    const HapticDevice* device = world.registry.find<HapticDevice>(probe.device);
    if (!device || device->driver != Driver::kScript || !device->path.valid()) continue;
    const Path& path = world.paths[device->path];
    if (!path.rows.empty()) longest = std::max(longest, path.rows.back().time);
  }
  return longest > 0.0 ? std::min(longest, kLongestDefault) : kDefaultSeconds;
}

std::uint64_t count_ticks(const RunOptions& options, const Prepared& run) {
  const double rate = run.world.simulation.touch_rate;
  const bool all = run.replay && options.seconds <= 0.0;
  const double seconds = options.seconds > 0.0 ? options.seconds : default_seconds(run.world);
  const auto wanted = static_cast<std::uint64_t>(std::max<long long>(1, std::llround(seconds * rate)));
  const std::uint64_t recorded = run.replay ? run.replay->ticks.size() : wanted;
  return all ? recorded : std::min(wanted, recorded);
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
    rows.push_back({figures.keeper.summaries()[i].name, figures.keeper.summaries()[i].source, &figures.keeper.traces()[i]});
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

Outcome run_prepared(const RunOptions& options, Prepared& run) {
  World& world = run.world;
  const double rate = world.simulation.touch_rate;
  const std::uint64_t ticks = count_ticks(options, run);

  auto out = OutputFolder::create(options.out.empty() ? "out/" + world.name : options.out);
  if (!out) return failed(out.error());
  Journal journal(world, options.realtime ? kJournalSeconds : 2.0 / rate);
  std::vector<std::string> sources;
  for (Entity probe : journal.probes())
    sources.push_back(run.replay ? "replay:" + options.replay : describe_source(world, probe));
  auto keeper = Keeper::create(world, journal.probes(), sources, out->stage("forces.csv"));
  if (!keeper) return failed(keeper.error());
  if (journal.probes().empty()) say(run, "the level has no probe, so nothing is touched; give one with --probe NAME=orbit");
  if (!options.record.empty()) {
    RecordingHeader header{world.name, rate, {}};
    for (const ProbeSummary& probe : keeper->summaries()) header.probes.push_back(probe.name);
    auto writer = RecordingWriter::create(options.record, header);
    if (!writer) return failed(writer.error());
    keeper->record_to(std::move(writer).value());
  }
  std::unique_ptr<Frames> frames;
  if (Outcome wrong = make_frames(options, run, frames)) return wrong;

  Schedule<World> schedule(touch_schedule());
  TouchLoop loop{world, schedule, journal, *keeper, *out, rate, ticks, frames.get(), {}, nullptr};
  loop.replay = run.replay ? &*run.replay : nullptr;
  if (frames)
    loop.frame_ticks = options.fps > 0.0 ? regular_frames(ticks, rate, options.fps)
                                         : spread_frames(ticks, options.frames < 0 ? kDefaultFrames : options.frames);
  std::uint64_t overruns = 0;
  const Status ran = options.realtime ? run_realtime(loop, overruns) : run_lockstep(loop);
  if (!ran) return failed(ran.error());
  Hash hash = journal.hash();
  hash_state(world, hash);
  release_devices(world);
  if (const Status kept = keeper->finish(); !kept) return failed(kept.error());

  RunFigures figures{world, schedule, journal, *keeper, frames.get(), options.realtime ? "realtime" : "lockstep", "cpu",
                     rate, overruns, explain_dropped(world.dropped), fmt::format("{:016x}", hash.value())};
  if (journal.lost() > 0)
    figures.dropped.push_back(fmt::format("{} rows of forces.csv were lost because writing fell behind: take fewer or "
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
  Outcome wrong = check(options);
  Prepared prepared;
  if (!wrong) wrong = prepare(options, prepared);
  if (!wrong) wrong = run_prepared(options, prepared);
  return wrong ? fail(wrong->status, wrong->error) : kDone;
}

}  // namespace pliant
