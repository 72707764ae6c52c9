#include "player/level/level_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "engine/run/driver_limits.h"
#include "engine/run/sources.h"
#include "player/level/window_run.h"
#include "player/run/duration.h"
#include "player/run/run_findings.h"
#include "pliant/drivers.h"
#include "pliant/process.h"
#include "systems/device/hands.h"
#include "systems/hash_state.h"
#include "systems/soft/soft_state.h"
#include "systems/touch/feed/touch_events.h"

namespace pliant {
namespace {

constexpr double kJournalSeconds = 8.0;  // [s] of rows buffered while a picture is drawn and written
constexpr int kDefaultFrames = 12;

Ran run_headless(const RunOptions& options, TouchLoop& loop) {
  Ran ran;
  ran.mode = options.realtime ? "realtime" : "lockstep";
  try {
    ran.ended = options.realtime ? run_realtime(loop) : run_lockstep(loop);
  } catch (const std::exception& error) {
    ran.ended = explain(error);
  }
  ran.overruns = loop.runner.overruns();
  if (loop.frames) {
    ran.drawn = loop.frames->figures();
    ran.pictures = loop.frames->count();
  }
  return ran;
}

// Keeps the remaining rows and closes every file.
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

}  // namespace

LevelRun::LevelRun(Prepared& run, Shown* shown, const Interrupt& interrupt)
    : run_(run), options_(run.options), shown_(shown), interrupt_(interrupt), world_(run.world) {}

Outcome LevelRun::open() {
  for (const auto step : {&LevelRun::plan_ticks, &LevelRun::open_devices, &LevelRun::open_results,
                          &LevelRun::open_recording, &LevelRun::open_frames})
    if (Outcome wrong = (this->*step)()) return wrong;
  attach();
  return {};
}

Outcome LevelRun::plan_ticks() {
  const RunLength length =
      run_length(options_.seconds, shown_, world_, run_.hands, run_.replay ? &*run_.replay : nullptr);
  ticks_ = length.ticks;
  const double pictures = static_cast<double>(ticks_) / world_.simulation.touch_rate * options_.fps;
  if (pictures > kMostFrames && !(shown_ && options_.seconds <= 0.0))
    return wrong_arguments(
        {"--fps", fmt::format("{:.0f} pictures are asked for, and a run takes at most {}; give a lower "
                              "one, or a shorter --seconds",
                              pictures, kMostFrames)});
  for (const std::string& sentence : length.notes) say(run_, sentence);
  return {};
}

// Devices need real time. A simulated device, or one sampled by the clock, may run in lockstep.
Outcome LevelRun::open_devices() {
  if (run_.replay) return {};
  register_all_drivers();
  std::vector<std::string> notes;
  const Status opened = devices_.open(
      world_, run_.hands, shown_, [this] { return interrupt_.requested(); }, notes);
  if (devices_.gave_up()) {  // its thread cannot be ended
    make_devices_safe();
    ::_exit(fail(kFailed, opened.error()));
  }
  for (const std::string& sentence : notes) say(run_, sentence);
  if (!opened) return wrong_arguments(opened.error());
  if (!realtime() && devices_.any_real() && !options_.lockstep) options_.realtime = true;
  devices_.use_clock(realtime() ? DeviceClock::kWall : DeviceClock::kTick);
  if (!devices_.any() || realtime()) return {};
  const Status may = devices_.may_step();
  return may ? Outcome() : wrong_arguments({"--lockstep", may.error().message()});
}

// Creates the folder of results and the files that grow during the run.
Outcome LevelRun::open_results() {
  auto out = OutputFolder::create(options_.out.empty() ? "out/" + world_.name : options_.out, options_.force);
  if (!out) return failed(out.error());
  out_.emplace(std::move(out).value());
  interrupt_.remove_if_forced(out_->staging());
  const double waiting = realtime() ? kJournalSeconds : 2.0 / world_.simulation.touch_rate;  // [s] of buffered rows
  if (world_.soft) bodies_.emplace(world_, static_cast<std::size_t>(waiting / world_.simulation.soft_step) + 3);
  journal_.emplace(world_, waiting, bodies_ ? &*bodies_ : nullptr);
  std::vector<std::string> sources;
  for (const Entity hand : journal_->probes())
    sources.push_back(run_.replay ? "replay:" + options_.replay : describe_source(world_, hand));
  auto keeper = Keeper::create(world_, journal_->probes(), sources, out_->stage("forces.csv"));
  if (!keeper) return failed(out_->at_place(keeper.error()));
  keeper_.emplace(std::move(keeper).value());
  keeper_->end_when_full(interrupt_);
  if (has_events(world_))
    if (const Status kept = keeper_->keep_events(out_->stage("events.csv")); !kept)
      return failed(out_->at_place(kept.error()));
  if (bodies_) {
    auto kept = BodyKeeper::create(world_, *bodies_, out_->stage("bodies.csv"));
    if (!kept) return failed(out_->at_place(kept.error()));
    keeper_->keep_bodies(std::move(kept).value());
  }
  if (journal_->probes().empty())
    say(run_, "the level has no probe and no tool, so nothing is touched; give one with --probe NAME=orbit");
  return {};
}

Outcome LevelRun::open_recording() {
  if (options_.record.empty()) return {};
  RecordingHeader header{world_.name, world_.simulation.touch_rate, {}, run_.scene, run_.settings};
  for (std::size_t i = 0; i < journal_->probes().size(); ++i) {
    header.probes.push_back(keeper_->summaries()[i].name);
    const Entity hand = journal_->probes()[i];
    if (!devices_.moves(hand)) continue;
    for (std::string& limit :
         driver_settings(header.probes.back(), world_.registry.get<HapticDevice>(device_of(world_, hand))))
      header.settings.push_back(std::move(limit));
  }
  auto writer = RecordingWriter::create(options_.record, header, options_.force);
  if (!writer) return failed(writer.error());
  interrupt_.remove_if_forced(writer->aside());
  recorder_ = &keeper_->record_to(std::move(writer).value());
  return {};
}

// Without a working graphics library, pictures that were not requested are left out with a note. A surface computed on
// the GPU is an error then.
Outcome LevelRun::open_frames() {
  if (shown_ || options_.frames == 0) return {};
  const bool asked = options_.frames >= 0 || options_.fps > 0.0;
  auto made = Frames::create(world_, options_.quality, options_.width, options_.height);
  if (made) {
    frames_ = std::move(made).value();
  } else if (asked) {
    return failed(made.error());
  } else if (world_.field_place == FieldPlace::kGpu) {
    return failed({"--field gpu", "there is no GPU to compute on: " + made.error().message() + ", or use --field cpu"});
  } else {
    say(run_, "running without pictures: " + made.error().message());
  }
  return {};
}

// Attaches the participants of a tick in order: the recording or the devices that move the hands, then the journals.
void LevelRun::attach() {
  runner_.emplace(world_);
  if (run_.replay) {
    replay_.emplace(world_, *run_.replay);
    TickPart withheld;
    withheld.after = [this](Tick) { replay_->end_tick(); };
    runner_->attach(std::move(withheld));
  }
  if (shown_ && !run_.sliders.empty()) {
    live_.emplace(world_);
    runner_->attach(live_->tick_part(recorder_));
  }
  if (devices_.any()) runner_->attach(devices_.tick_part(world_));
  TickPart noted;
  noted.after = [this](Tick tick) {
    if (recorder_) recorder_->note(world_, journal_->probes(), tick);
    journal_->note(world_, tick);
  };
  runner_->attach(std::move(noted));
  if (runner_->soft().any()) {
    runner_->soft().note_in(*bodies_);
    if (recorder_ && realtime())
      say(run_, "the steps of the soft clock are not recorded: a replay of " + options_.record +
                    " follows the same poses, but its hash will differ; record with --lockstep for the same bits");
  }
  if (!frames_ && !shown_) return;
  const int spread = options_.frames >= 0 ? options_.frames : shown_ ? 0 : kDefaultFrames;
  frame_ticks_ = options_.fps > 0.0 ? regular_frames(ticks_, world_.simulation.touch_rate, options_.fps)
                                    : spread_frames(ticks_, spread);
}

void LevelRun::go(std::optional<Prepared>& next) {
  TouchLoop loop{*runner_,
                 *journal_,
                 *keeper_,
                 *out_,
                 interrupt_,
                 ticks_,
                 frames_.get(),
                 frame_ticks_,
                 replay_ ? &*replay_ : nullptr,
                 live_ ? &*live_ : nullptr};
  Prepared other;
  ran_ = shown_ ? run_shown(options_, run_, *shown_, loop, devices_, other) : run_headless(options_, loop);
  runner_->stop();  // an exception may have left it running
  if (ran_.opened) next = std::move(other);
}

void LevelRun::take(const Status& status) {
  if (!status && !wrong_) wrong_ = out_->at_place(status.error());
}

Outcome LevelRun::close() {
  if (runner_->soft().any()) world_.dropped |= world_.soft->dropped;
  Hash hash = journal_->hash();
  hash_state(world_, hash);
  const double rate = world_.simulation.touch_rate;
  let_go(world_, {journal_->ticks(), 1.0 / rate, static_cast<double>(journal_->ticks()) / rate});
  if (const std::optional<Error> reason = interrupt_.reason()) take(*reason);
  take(ran_.ended);
  if (wrong_ && journal_->ticks() == 0) return failed(*wrong_);
  if (keeper_->recorded_nothing()) say(run_, options_.record + " is not written, because no tick was recorded");
  take(finish(*keeper_, *journal_));

  RunFigures figures = this->figures(hash.value());
  add_findings(figures);
  if (const std::optional<Error> lost = write_reports(figures, *out_); lost && !wrong_) wrong_ = lost;
  print_summary(figures, *out_);
  if (ran_.opening.valid() && ran_.opening.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    note("results are written; waiting until the file that was dropped is read");
  if (ran_.hung) leave_hung();
  return wrong_ ? failed(*wrong_) : Outcome();
}

RunFigures LevelRun::figures(std::uint64_t hash) {
  RunFigures figures{world_,
                     runner_->schedule(),
                     *journal_,
                     *keeper_,
                     ran_.drawn ? &*ran_.drawn : nullptr,
                     ran_.pictures,
                     ran_.mode,
                     world_.field_place == FieldPlace::kGpu ? "gpu" : "cpu",
                     world_.simulation.touch_rate,
                     ran_.overruns,
                     explain_dropped(world_.dropped),
                     fmt::format("{:016x}", hash),
                     runner_->soft().any() ? &runner_->soft() : nullptr,
                     {},
                     wrong_                   ? sentence_of(kFailed, *wrong_)
                     : interrupt_.requested() ? "interrupted"
                                              : "done",
                     run_.replay.has_value()};
  devices_.view(figures.devices);
  return figures;
}

// Findings of the run, for stderr and the report.
void LevelRun::add_findings(RunFigures& figures) {
  std::vector<Note> notes = std::exchange(figures.notes, {});
  try {
    for (Note& found : explain_run(figures, devices_)) notes.push_back(std::move(found));
    for (Note& found : devices_.findings()) notes.push_back(std::move(found));
  } catch (const std::exception& error) {  // the figures are written without them
    figures.misses.resize(journal_->probes().size());
    take(explain(error));
  }
  const std::uint64_t reached = std::max<std::uint64_t>(journal_->ticks() + ran_.overruns, 1) - 1;
  const auto due = static_cast<std::size_t>(std::lower_bound(frame_ticks_.begin(), frame_ticks_.end(), reached) -
                                            frame_ticks_.begin());
  if (ran_.pictures < due && !wrong_)
    notes.push_back({fmt::format("{} of {} pictures were not taken because drawing is slower than the run",
                                 due - ran_.pictures, due),
                     "take fewer or smaller ones",
                     "run.pictures_missed",
                     {}});
  const std::uint64_t rows = journal_->ticks() * journal_->probes().size();
  for (const auto& [lost, file] : {std::pair(rows - std::min(rows, keeper_->rows()), "forces.csv"),
                                   {bodies_ ? bodies_->lost() : 0, "bodies.csv"},
                                   {journal_->events_lost(), "events.csv"}})
    if (lost > 0)
      notes.push_back({fmt::format("{} rows of {} were lost because the disk was too slow", lost, file),
                       "use a faster disk, a lower --rate or fewer pictures", "run.rows_lost", file});
  if (std::optional<Note> events = explain_events(world_)) notes.push_back(*std::move(events));
  for (const Note& found : notes) {
    note(found.message());
    figures.notes.push_back(found);
  }
  figures.notes.insert(figures.notes.end(), run_.notes.begin(), run_.notes.end());
}

// A picture is stuck: its thread still uses the window and the world.
void LevelRun::leave_hung() {
  { const OutputFolder done = std::move(*out_); }
  std::fflush(stdout);
  ::_exit(wrong_ ? fail(kFailed, *wrong_) : kDone);
}

}  // namespace pliant
