// pliant run: a level or mesh, its probes, the loop, and what is written about it.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <future>
#include <optional>
#include <utility>

#include "content/device_answers.h"
#include "content/files/file_io.h"
#include "content/level/soft_store.h"
#include "editor/app/settings.h"
#include "editor/ui/device_list.h"
#include "engine/body_journal.h"
#include "engine/driver_limits.h"
#include "engine/journal.h"
#include "engine/sources.h"
#include "engine/touch_clock.h"
#include "player/record/keeper.h"
#include "player/record/output_folder.h"
#include "player/run/duration.h"
#include "player/run/frames.h"
#include "player/run/report.h"
#include "player/run/tool_words.h"
#include "player/run/touch_loop.h"
#include "player/verbs/run_setup.h"
#include "player/window/window_session.h"
#include "pliant/process.h"
#include "runtime/parallel.h"
#include "systems/device/hands.h"
#include "systems/hash_state.h"
#include "systems/schedule.h"
#include "systems/soft/soft_state.h"
#include "systems/tool/prepare_tools.h"

namespace pliant {
namespace {

constexpr double kJournalSeconds = 8.0;  // [s] of rows that may wait while a picture is drawn and written
constexpr int kDefaultFrames = 12;
constexpr int kWindowWidth = 1280, kWindowHeight = 720;  // [pixel]

Outcome check(const RunOptions& options) {
  if (options.field == "gpu" && options.frames == 0)
    return wrong_arguments({"--field gpu", "computes the surface for pictures; leave out --frames 0"});
  if (options.sized && options.frames == 0 && (options.headless || options.lockstep || !options.replay.empty()))
    return wrong_arguments({"--size", "is of pictures and windows; leave out --frames 0"});
  if (!options.replay.empty() && options.realtime)
    return wrong_arguments({"--replay", "runs in lockstep; leave out --realtime"});
  if (!options.replay.empty() && !options.probes.empty())
    return wrong_arguments({"--replay", "moves every probe itself; leave out --probe"});
  if (!options.replay.empty() && options.window)
    return wrong_arguments({"--replay", "runs in lockstep, which a window does not; leave out --window"});
  return {};
}

// A window and what is to be shown in it.
struct Shown {
  std::unique_ptr<Window> window;
  InputScript script;
};

// A window where there is a display, unless that was forbidden or what is asked for needs virtual time. Without one,
// only an order to have one is a failure.
Outcome open_window(const RunOptions& options, Shown& shown) {
  const bool possible = !options.headless && !options.lockstep && options.replay.empty();
  if (!options.window && (!possible || !Window::display_is_there())) {
    if (!options.input.empty())
      return wrong_arguments(
          {"--input", "needs a window; leave out --headless, --lockstep and --replay, and set DISPLAY"});
    return {};
  }
  if (!options.input.empty()) {
    auto script = InputScript::load(options.input);
    if (!script) return failed(script.error());
    shown.script = std::move(script).value();
  }
  auto window = Window::create(options.sized ? options.width : kWindowWidth,
                               options.sized ? options.height : kWindowHeight, ", or use --headless");
  if (!window) {
    if (options.window) return failed(window.error());
    note("running without a window: " + window.error().what);
    return {};
  }
  if (options.frames > 0 && options.seconds <= 0.0)
    return wrong_arguments({"--frames", "spreads pictures over a duration; give --seconds, or use --fps"});
  shown.window = std::move(window).value();
  return {};
}

// Without a working graphics library, pictures that nobody asked for are left out with a note. A surface that is to be
// computed on the GPU cannot be.
Outcome make_frames(const RunOptions& options, Prepared& run, std::unique_ptr<Frames>& frames) {
  const bool asked = options.frames >= 0 || options.fps > 0.0;
  if (options.frames == 0) return {};
  auto made = Frames::create(run.world, options.width, options.height);
  if (made) {
    frames = std::move(made).value();
  } else if (asked) {
    return failed(made.error());
  } else if (run.world.field_place == FieldPlace::kGpu) {
    return failed({"--field gpu", "there is no GPU to compute on: " + made.error().message() + ", or use --field cpu"});
  } else {
    say(run, "running without pictures: " + made.error().message());
  }
  return {};
}

// Something in this run could move this probe or tool.
bool is_moved(const RunFigures& figures, std::size_t hand) {
  const HapticDevice* device = find_device(figures.world, figures.journal.probes()[hand]);
  const DriverKind driver = device ? device->driver : DriverKind::kNull;
  if (driver == DriverKind::kMouse) return figures.mode == "window";
  if (driver == DriverKind::kExternal) {
    const std::string& source = figures.keeper.summaries()[hand].source;
    return source == "hand" || source.starts_with("hand:") || source.starts_with("replay:") ||
           (source.starts_with("device:") && source != "device:");
  }
  return driver != DriverKind::kNull;
}

// Nothing silent: what kept a hand from what the law says, who touched nothing at all, and what soft steps left
// imperfect.
std::vector<std::string> explain_run(RunFigures& figures, DeviceLinks& devices) {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < figures.journal.probes().size(); ++i) {
    const Entity hand = figures.journal.probes()[i];
    const ProbeSummary& summary = figures.keeper.summaries()[i];
    figures.misses.emplace_back();
    if (summary.contact_ticks == 0 && devices.never_ready(hand)) {
      // its device says why
    } else if (summary.contact_ticks == 0 && !is_moved(figures, i)) {
      sentences.push_back(fmt::format("{} `{}` never touched anything: nothing moves it; give it --probe {}=orbit",
                                      summary.tool ? "tool" : "probe", summary.name, summary.name));
    } else if (const Probe* probe = figures.world.registry.find<Probe>(hand); summary.contact_ticks == 0 && probe) {
      figures.misses.back() = find_miss(figures.world, summary.approach, probe->radius);
      sentences.push_back(explain_miss(summary.name, figures.misses.back()));
    } else if (summary.contact_ticks == 0) {
      sentences.push_back("tool `" + summary.name +
                          "` never touched anything; move its device into contact (script, or --probe " + summary.name +
                          "=orbit)");
    }
    for (std::string& sentence : explain_limits(figures.world, hand, summary.name))
      sentences.push_back(std::move(sentence));
    for (std::string& sentence : explain_tool(figures.world, summary)) sentences.push_back(std::move(sentence));
  }
  if (figures.soft)
    for (std::string& sentence : explain_soft_steps(figures.world, figures.soft->figures()))
      sentences.push_back(std::move(sentence));
  return sentences;
}

// Options for a file that was dropped, of those that were asked for: what was said of the first level's nodes and files
// is not meant for it. `left`: which those are.
RunOptions another_level(const RunOptions& asked, const std::string& file, std::string& left) {
  RunOptions other = asked;
  other.level = file;
  for (const auto& [given, name] : {std::pair(!asked.probes.empty(), "--probe"),
                                    {!asked.sets.empty(), "--set"},
                                    {!asked.record.empty(), "--record"},
                                    {!asked.tool_force.empty(), "--tool-force"},
                                    {asked.unit != 1.0, "--unit"},
                                    {asked.force, "--force"}})
    if (given) left += std::string(left.empty() ? "" : ", ") + name;
  other.probes.clear();
  other.sets.clear();
  other.record.clear();
  other.force = false;
  other.tool_force.clear();
  other.unit = 1.0;
  if (!asked.out.empty()) other.out = asked.out + "/" + std::filesystem::path(file).stem().string();
  return other;
}

// The same level anew, beside what was written of it.
RunOptions same_level(const RunOptions& options, const RunOptions& asked) {
  RunOptions other = options;
  other.force = false;
  std::error_code ignored;
  // The recording under way has its place soon.
  for (int n = 2; !options.record.empty() &&
                  (n == 2 || other.record == options.record || std::filesystem::exists(other.record, ignored));
       ++n)
    other.record = numbered(asked.record, n).string();
  return other;
}

// What a run was like, whichever clock it ran on, and however it ended.
struct Ran {
  std::string mode;
  std::uint64_t overruns = 0;
  std::optional<FrameFigures> drawn;
  std::size_t pictures = 0;
  bool opened = false;    // another level takes its place
  Status ended = Done{};  // what ended it early
  bool hung = false;      // in a picture (window_session.h)
  std::future<std::optional<Error>> opening;
};

Ran run_headless(const RunOptions& options, TouchLoop& loop) {
  Ran ran;
  ran.mode = options.realtime ? "realtime" : "lockstep";
  try {
    ran.ended = options.realtime ? run_realtime(loop, ran.overruns) : run_lockstep(loop);
  } catch (const std::exception& error) {
    ran.ended = explain(error);
  }
  if (loop.frames) {
    ran.drawn = loop.frames->figures();
    ran.pictures = loop.frames->count();
  }
  return ran;
}

// What a level asks for beyond what it may, as a window says it.
std::vector<std::string> question_of(const Prepared& run) {
  if (run.refused.empty()) return {};
  std::vector<std::string> lines{
      "This level asks for devices, addresses or files of this machine. Allow it only if you "
      "know who made it."};
  for (const LevelRequest& asked : run.refused) {
    lines.push_back("`" + asked.moves + "` by " + asked.id);
    for (const std::string& sentence : asked.request.refused) lines.push_back("    " + sentence);
  }
  return lines;
}

Status allow_all(const Prepared& run) {
  DeviceAnswers answers = DeviceAnswers::load();
  for (const LevelRequest& asked : run.refused)
    if (Status kept = answers.allow(run.file, asked.id); !kept) return kept;
  return Done{};
}

Ran run_shown(const RunOptions& options, const Prepared& run, Shown& shown, TouchLoop& loop, Prepared& next) {
  const RunOptions& asked = run.asked;
  WindowSession session{*shown.window, shown.script, loop.world, loop.schedule,
                        loop.journal,  loop.keeper,  loop.out,   loop.interrupt};
  session.soft = loop.soft;
  session.devices = loop.devices;
  session.level = options.level;
  session.question = question_of(run);
  session.allow = [&run] { return allow_all(run); };
  std::string unread;
  const Settings settings = Settings::load({}, unread);
  if (!unread.empty()) note(unread);
  const auto keys = settings.keys.find(ui::kStopAction);
  session.stop_keys = keys == settings.keys.end() || keys->second.empty() ? ui::kStopKeys : keys->second;
  session.rate = loop.rate;
  session.ticks = loop.ticks;
  session.frame_width = options.width;
  session.frame_height = options.height;
  session.frame_ticks = loop.frame_ticks;
  // Measuring needs the context, which is this thread's: what was chosen for the first level holds for the next.
  const std::string field = loop.world.field_place == FieldPlace::kGpu ? "gpu" : "cpu";
  session.open = [&options, &asked, &next, field](const std::string& file) -> std::optional<Error> {
    next = Prepared();
    std::string left;
    RunOptions other = file == options.level ? same_level(options, asked) : another_level(asked, file, left);
    other.field = field;
    if (Outcome wrong = prepare(other, true, next)) return wrong->error;
    if (!left.empty())
      say(next, fmt::format("the options {} are for the first level and do not hold for `{}`", left, next.world.name));
    next.options = other;
    next.asked = asked;
    return {};
  };
  try {
    WindowFigures figures = run_window(session);
    return {"window",       figures.overruns, figures.frames, figures.pictures,
            figures.opened, figures.ended,    figures.hung,   std::move(figures.opening)};
  } catch (const std::exception& error) {
    Ran ran;
    ran.mode = "window";
    ran.ended = explain(error);
    return ran;
  }
}

// The rows that still wait, then every file is closed.
Status finish(Keeper& keeper, Journal& journal) {
  Status kept = Done{};
  try {
    keeper.keep(journal);
  } catch (const std::exception& error) {
    kept = explain(error);
  }
  const Status closed = keeper.finish();
  return kept ? closed : kept;
}

// Devices are felt in real time; a simulated one, or one whose samples come by the clock, may be stepped.
Outcome open_devices(RunOptions& options, bool windowed, Prepared& run, const Interrupt& interrupt,
                     DeviceLinks& devices) {
  std::vector<std::string> notes;
  const auto stop = [&interrupt] { return interrupt.requested(); };
  const Status opened = devices.open(run.world, run.hands, windowed, stop, notes);
  if (devices.gave_up()) {  // a thread that nobody can end still opens it
    make_devices_safe();
    ::_exit(fail(kFailed, opened.error()));
  }
  for (const std::string& sentence : notes) say(run, sentence);
  if (!opened) return wrong_arguments(opened.error());
  if (!options.realtime && !windowed && devices.any_real() && !options.lockstep) options.realtime = true;
  devices.use_clock(windowed || options.realtime ? DeviceClock::kWall : DeviceClock::kTick);
  if (!devices.any() || windowed || options.realtime) return {};
  const Status may = devices.may_step();
  return may ? Outcome() : wrong_arguments({"--lockstep", may.error().message()});
}

// `shown`: the window, or null. `next`: what is to be run after this, if a window asked for it.
Outcome run_prepared(RunOptions options, Prepared& run, Shown* shown, const Interrupt& interrupt,
                     std::optional<Prepared>& next) {
  World& world = run.world;
  const double rate = world.simulation.touch_rate;
  const RunLength length = run_length(options.seconds, shown, world, run.hands, run.replay ? &*run.replay : nullptr);
  const std::uint64_t ticks = length.ticks;
  if (const double pictures = static_cast<double>(ticks) / rate * options.fps;
      pictures > kMostFrames && !(shown && options.seconds <= 0.0))
    return wrong_arguments(
        {"--fps", fmt::format("{:.0f} pictures are asked for, and a run takes at most {}; give a lower "
                              "one, or a shorter --seconds",
                              pictures, kMostFrames)});
  for (const std::string& sentence : length.notes) say(run, sentence);

  DeviceLinks devices;
  if (!run.replay)
    if (Outcome wrong = open_devices(options, shown, run, interrupt, devices)) return wrong;

  auto out = OutputFolder::create(options.out.empty() ? "out/" + world.name : options.out, options.force);
  if (!out) return failed(out.error());
  interrupt.remove_if_forced(out->staging());
  const double waiting = options.realtime || shown ? kJournalSeconds : 2.0 / rate;  // [s] of rows
  std::optional<BodyJournal> bodies;
  if (world.soft) bodies.emplace(world, static_cast<std::size_t>(waiting / world.simulation.soft_step) + 3);
  Journal journal(world, waiting, bodies ? &*bodies : nullptr);
  std::vector<std::string> sources;
  for (Entity probe : journal.probes())
    sources.push_back(run.replay ? "replay:" + options.replay : describe_source(world, probe));
  auto keeper = Keeper::create(world, journal.probes(), sources, out->stage("forces.csv"));
  if (!keeper) return failed(out->at_place(keeper.error()));
  keeper->end_when_full(interrupt);
  if (bodies) {
    auto kept = BodyKeeper::create(world, *bodies, out->stage("bodies.csv"));
    if (!kept) return failed(out->at_place(kept.error()));
    keeper->keep_bodies(std::move(kept).value());
  }
  if (journal.probes().empty())
    say(run, "the level has no probe and no tool, so nothing is touched; give one with --probe NAME=orbit");
  if (!options.record.empty()) {
    RecordingHeader header{world.name, rate, {}, run.scene, run.settings};
    for (std::size_t i = 0; i < journal.probes().size(); ++i) {
      header.probes.push_back(keeper->summaries()[i].name);
      const Entity hand = journal.probes()[i];
      if (!devices.moves(hand)) continue;
      for (std::string& limit :
           driver_settings(header.probes.back(), world.registry.get<HapticDevice>(device_of(world, hand))))
        header.settings.push_back(std::move(limit));
    }
    auto writer = RecordingWriter::create(options.record, header, options.force);
    if (!writer) return failed(writer.error());
    interrupt.remove_if_forced(writer->aside());
    keeper->record_to(std::move(writer).value());
  }
  std::unique_ptr<Frames> frames;
  if (!shown)
    if (Outcome wrong = make_frames(options, run, frames)) return wrong;

  Schedule<World> schedule(touch_schedule());
  TouchLoop loop{world, schedule, journal, *keeper, *out, interrupt, rate, ticks, frames.get(), {}, nullptr};
  loop.replay = run.replay ? &*run.replay : nullptr;
  if (devices.any()) loop.devices = &devices;
  if (options.realtime || shown) limit_tool_ticks(world);
  SoftClock soft(world);
  if (soft.any()) {
    loop.soft = &soft;
    soft.note_in(*bodies);
    if (!options.record.empty() && (options.realtime || shown))
      say(run, "the steps of the soft clock are not recorded: a replay of " + options.record +
                   " follows the same poses, but its hash will differ; record with --lockstep for the same bits");
  }
  if (frames || shown) {
    const int spread = options.frames >= 0 ? options.frames : shown ? 0 : kDefaultFrames;
    loop.frame_ticks = options.fps > 0.0 ? regular_frames(ticks, rate, options.fps) : spread_frames(ticks, spread);
  }
  Prepared other;
  const Ran ran = shown ? run_shown(options, run, *shown, loop, other) : run_headless(options, loop);
  soft.stop();  // where an exception left it running
  if (ran.opened) next = std::move(other);
  if (soft.any()) world.dropped |= world.soft->dropped;
  Hash hash = journal.hash();
  hash_state(world, hash);
  let_go(world, {journal.ticks(), 1.0 / rate, static_cast<double>(journal.ticks()) / rate});
  // Whatever ended the run: what ran is written, and then the first error is said.
  std::optional<Error> wrong = interrupt.reason();
  const auto take = [&](const Status& status) {
    if (!status && !wrong) wrong = out->at_place(status.error());
  };
  if (wrong) wrong = out->at_place(*wrong);
  take(ran.ended);
  if (wrong && journal.ticks() == 0) return failed(*wrong);  // what is staged goes, and replaces nothing
  if (keeper->recorded_nothing()) say(run, options.record + " is not written, because no tick was recorded");
  take(finish(*keeper, journal));

  RunFigures figures{world,
                     schedule,
                     journal,
                     *keeper,
                     ran.drawn ? &*ran.drawn : nullptr,
                     ran.pictures,
                     ran.mode,
                     world.field_place == FieldPlace::kGpu ? "gpu" : "cpu",
                     rate,
                     ran.overruns,
                     explain_dropped(world.dropped),
                     fmt::format("{:016x}", hash.value()),
                     loop.soft,
                     {},
                     wrong                   ? sentence_of(kFailed, *wrong)
                     : interrupt.requested() ? "interrupted"
                                             : "done"};
  devices.view(figures.devices);
  std::vector<std::string> sentences;
  try {
    sentences = explain_run(figures, devices);
    for (std::string& sentence : devices.findings()) sentences.push_back(std::move(sentence));
  } catch (const std::exception& error) {  // the figures are written without them
    figures.misses.resize(journal.probes().size());
    take(explain(error));
  }
  const std::uint64_t reached = journal.ticks() + ran.overruns;
  const auto due = static_cast<std::size_t>(
      std::lower_bound(loop.frame_ticks.begin(), loop.frame_ticks.end(), std::max<std::uint64_t>(reached, 1) - 1) -
      loop.frame_ticks.begin());
  if (ran.pictures < due && !wrong)
    sentences.push_back(fmt::format(
        "{} of {} pictures were not taken because drawing is slower than the run; take fewer or smaller ones",
        due - ran.pictures, due));
  const std::uint64_t rows = journal.ticks() * journal.probes().size();
  for (const auto& [lost, file] :
       {std::pair(rows - std::min(rows, keeper->rows()), "forces.csv"), {bodies ? bodies->lost() : 0, "bodies.csv"}})
    if (lost > 0)
      sentences.push_back(
          fmt::format("{} rows of {} were lost because the disk was too slow; use a faster disk, a lower --rate or "
                      "fewer pictures",
                      lost, file));
  for (const std::string& sentence : sentences) {
    note(sentence);
    figures.dropped.push_back(sentence);
  }
  figures.dropped.insert(figures.dropped.end(), run.notes.begin(), run.notes.end());
  if (const std::optional<Error> lost = write_reports(figures, *out); lost && !wrong) wrong = lost;
  print_summary(figures, *out);
  if (ran.opening.valid() && ran.opening.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    note("results are written; waiting until the file that was dropped is read");
  if (ran.hung) {  // a thread that nobody can end uses the window and the world
    { const OutputFolder done = std::move(*out); }
    std::fflush(stdout);
    ::_exit(wrong ? fail(kFailed, *wrong) : kDone);
  }
  return wrong ? failed(*wrong) : Outcome();
}

}  // namespace

int run(const RunOptions& options) {
  set_thread_count(options.threads);
  set_soft_store(options.soft_store);
  if (Outcome wrong = check(options)) return fail(wrong->status, wrong->error);
  Shown shown;
  if (Outcome wrong = open_window(options, shown)) return fail(wrong->status, wrong->error);
  const bool windowed = shown.window != nullptr;
  std::optional<Prepared> next(std::in_place);
  next->options = next->asked = options;
  Outcome wrong = prepare(options, windowed, *next);
  const Interrupt interrupt;
  while (!wrong && next) {
    Prepared now = std::move(*next);
    next.reset();
    wrong = run_prepared(now.options, now, windowed ? &shown : nullptr, interrupt, next);
    if (interrupt.requested()) next.reset();
  }
  return wrong ? fail(wrong->status, wrong->error) : kDone;
}

}  // namespace pliant
