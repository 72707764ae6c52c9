// A run's own thread: opens the session, runs batches of ticks, publishes the state.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "content/files/exr.h"
#include "content/safety_cap.h"
#include "editor/play/play_inside.h"
#include "engine/run/sources.h"
#include "runtime/clock.h"
#include "systems/device/repeat.h"
#include "systems/hash_state.h"
#include "systems/touch/feed/publish.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

constexpr double kTickSlice = 0.012;      // [s] of ticks in a batch, so that commands are processed
constexpr double kFarthestBehind = 0.05;  // [s] a slow machine plays more slowly; it does not catch up
constexpr auto kTurn = std::chrono::milliseconds(4);
constexpr auto kIdleTurn = std::chrono::milliseconds(15);
constexpr double kShowEvery = 0.03, kPaceOver = 0.5;  // [s]
constexpr double kRowSeconds = 4.0;                   // [s] of rows that may be buffered for this thread

double seconds_since(std::uint64_t then) {
  return static_cast<double>(now_ns() - then) * 1e-9;
}

std::string words_of(const World& world, const SessionEffector& effector, const PlaySource& source) {
  switch (source.kind) {
    case PlaySource::Kind::kLevel:
      return describe_source(world, effector.entity);
    case PlaySource::Kind::kMouse:
      return "mouse";
    case PlaySource::Kind::kScript:
      return "script:" + source.what;
    case PlaySource::Kind::kOrbit:
      return "orbit";
    case PlaySource::Kind::kNone:
      return "none";
    case PlaySource::Kind::kDriver:
      return "device:" + source.what;
  }
  return {};
}

// A name not used in the level.
std::string free_name(const Level& level, std::string name) {
  const auto taken = [&](const LevelNode& node) { return node.name == name; };
  while (std::any_of(level.nodes.begin(), level.nodes.end(), taken)) name += "'";
  return name;
}

bool wants_mouse(const Level& level, const PlayOptions& options) {
  if (!options.mouse_probe) return false;
  for (const auto& [name, source] : options.sources)
    if (source.kind == PlaySource::Kind::kMouse) return false;
  return std::none_of(level.nodes.begin(), level.nodes.end(), [](const LevelNode& node) {
    if (node.handle) return true;  // the mouse will drag it
    if (!node.device) return false;
    const HapticDevice& device = *node.device;
    return device.driver == DriverKind::kMouse ||
           (device.driver == DriverKind::kExternal && device.id.find("mouse") != std::string::npos);  // may be
  });
}

}  // namespace

void PlayRun::run() {
  Inside& in = *inside_;
  std::string error;
  try {
    Status done = open(in);
    if (done) {
      opened_ = true;
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return end_ || pictured_ || !options_.shown; });
    }
    if (done && !end_) done = begin(in);
    while (done && !end_) turn(in);
    if (!done) error = done.error().message();
  } catch (const std::exception& thrown) {
    error = thrown.what();
  }
  end_ = true;
  close(in);
  if (!error.empty()) in.status.error = error;
  in.status.phase = PlayPhase::kEnded;
  in.report();
  const std::lock_guard lock(mutex_);
  ended_ = true;
  busy_ = false;
  commands_.clear();
  changed_.notify_all();
}

void PlayRun::Inside::report() {
  run.reported_.write() = status;
  run.reported_.publish();
}

PlayPast PlayRun::Inside::past() const {
  PlayPast past;
  if (kept) static_cast<Recording&>(past) = kept->copy();
  past.header.rate = inner->world.simulation.touch_rate;
  past.holds = holds;
  return past;
}

Status PlayRun::open(Inside& in) {
  Result<Level> level = options_.level();
  if (!level) return level.error();
  if (!level->has_pliant()) {
    make_touchable(*level);
    in.say("nothing in this level is deformable yet, so every mesh is while it is played; add a Deformable to keep it");
  }
  for (std::string& sentence : cap_safety(*level, {})) in.say(sentence);
  if (wants_mouse(*level, options_)) {
    const std::string name = free_name(*level, "mouse");
    if (Status s = add_probes(*level, {{name, DriverKind::kMouse, {}}}); !s) return s;
    options_.sources.emplace_back(name, PlaySource{PlaySource::Kind::kMouse, {}});
  }
  auto session = Session::open(Scene(*level));
  if (!session) return session.error();
  in.session = std::move(session).value();
  in.inner = &SessionRun::of(*in.session);
  World& world = in.inner->world;
  for (const std::string& note : in.session->notes()) in.say(note);
  if (level->environment && !level->environment->panorama.empty()) {
    auto panorama = load_named_panorama(level->path.parent_path(), level->environment->panorama, &in.notes);
    if (panorama)
      world.environment.panorama = std::move(panorama).value();
    else
      in.say("the surroundings cannot be shown: " + panorama.error().message());
  }
  const std::size_t count = in.inner->effectors.size();
  if (count == 0) in.say("the level has no probe and no tool, so nothing is touched");
  in.journal.emplace(world, kRowSeconds);
  in.inner->noted = [&in](Tick tick) { in.journal->note(in.inner->world, tick); };
  in.limited.resize(count);
  in.sources.resize(count);
  in.realtime = options_.realtime && !options_.past;
  in.paused = options_.paused;
  in.speed = options_.speed;
  if (options_.repeats) repeat_scripts(world);
  for (auto [entity, device] : world.registry.view<const HapticDevice>())
    if (device.driver == DriverKind::kScript && device.path.valid())
      in.period = std::max(in.period, world.paths[device.path].rows.back().time);
  for (const SessionEffector& effector : in.inner->effectors) in.of_level.push_back(in.remember(effector));
  in.apply_all();
  if (!options_.past && !in.realtime && in.feels()) {
    in.realtime = true;
    in.watch();
    in.say("a device feels in real time only, so the level plays in real time");
  }
  if (options_.past) in.begin_past(*options_.past, options_.until);
  if (count > 0) {
    auto sink = std::make_unique<KeptRecording>(count, PlayPast::kMostTicks);
    in.kept = sink.get();
    in.inner->recorder = std::make_unique<PoseRecorder>(std::move(sink), count);
  }
  {
    const std::lock_guard lock(mutex_);
    samples_.resize(count);
  }
  in.status.objects = in.inner->objects;
  show(in);
  return Done{};
}

Status PlayRun::begin(Inside& in) {
  const std::lock_guard works(stands_still_);
  if (in.realtime) {
    in.move_hand(0.0);
    if (Status s = in.session->start(); !s) return s;
    if (in.paused) static_cast<void>(in.session->pause(true));
  }
  in.opening = false;
  in.turned_ns = in.paced_ns = now_ns();
  return Done{};
}

Status PlayRun::Inside::tick() {
  hold_again();
  move_hand(1.0 / inner->world.simulation.touch_rate);
  const Status done = session->step(1);
  take_rows();
  return done;
}

void PlayRun::Inside::move_hand(double dt) {
  if (again) return;
  if (!watched.empty() && run.hand.takes()) apply(std::exchange(watched, {}), {PlaySource::Kind::kMouse, {}});
  if (moved.empty()) return;
  const std::optional<dvec3> to = run.hand.update(dt);
  if (!to) return;
  SessionEffector& effector = *inner->find_effector(moved);
  const ProbeHold hold = run.hand.probe_hold();
  if (!(hold == effector.hold) && kept->ticks() < PlayPast::kMostTicks) {
    const std::uint64_t at = realtime && inner->clock() ? inner->clock()->now() + 1 : inner->ticks;
    holds.push_back({at, static_cast<std::uint32_t>(&effector - inner->effectors.data()), hold});
  }
  effector.hold = hold;
  static_cast<void>(session->move(moved, *to, held));
}

// Restores the mouse's drags of a repeated past.
void PlayRun::Inside::hold_again() {
  if (!again) return;
  for (const auto& had = run.options_.past->holds; next_hold < had.size() && had[next_hold].tick <= inner->ticks;
       ++next_hold) {
    const PlayHold& hold = had[next_hold];
    if (Probe* const probe = inner->world.registry.find<Probe>(inner->effectors[hold.effector].entity))
      probe->hold = hold.hold;
    inner->effectors[hold.effector].hold = hold.hold;
    holds.push_back(hold);
  }
}

void PlayRun::Inside::take_rows() {
  rows.clear();
  journal->drain(rows);
  if (rows.empty()) return;
  const std::size_t count = inner->effectors.size();
  const std::lock_guard lock(run.mutex_);
  for (const TickRow& row : rows) {
    if (row.probe >= count) continue;
    PlaySample sample;
    sample.tick = row.tick;
    sample.time = row.time;
    sample.force = static_cast<float>(glm::length(row.reading.force));
    sample.along = static_cast<float>(row.reading.normal_force);
    sample.depth = static_cast<float>(row.reading.depth);
    sample.limited = row.limited;
    sample.touching = row.reading.in_contact;
    for (std::size_t i = 0; i < inner->object_entities.size(); ++i)
      if (sample.touching && inner->object_entities[i] == row.reading.object)
        sample.object = static_cast<std::uint16_t>(i);
    for (std::size_t i = 0; i < kSafetyLimits; ++i) limited[row.probe][i] += (row.limited >> i) & 1u;
    run.samples_[row.probe].push_back(sample);
  }
}

// Publishes all changes, after the last tick.
void PlayRun::Inside::flush() {
  World& world = inner->world;
  if (world.snapshots->unseen()) return;
  const bool dirty = std::any_of(world.touch->objects.begin(), world.touch->objects.end(),
                                 [](const ObjectState& object) { return !object.dirty.empty(); });
  if (flushed == inner->ticks && !dirty) return;
  flushed = inner->ticks;
  publish(world, inner->last);
}

void PlayRun::turn(Inside& in) {
  std::vector<Command> commands;
  std::unique_lock works(stands_still_);
  {
    const std::lock_guard lock(mutex_);
    commands.swap(commands_);
  }
  for (const Command& command : commands) command(in);
  const double passed = seconds_since(in.turned_ns);
  in.turned_ns = now_ns();
  const std::uint64_t began = in.turned_ns;
  const double rate = in.inner->world.simulation.touch_rate;
  Status status = Done{};
  bool more = false;
  if (in.realtime) {
    if (!in.session->running()) {
      status = in.session->stop();
      if (status) status = Error{"play", "the touch clock has ended", "press Play again"};
    } else {
      in.move_hand(passed);
      in.take_rows();
    }
  } else {
    if (in.again) {
      while (status && !end_ && in.inner->ticks < in.until && seconds_since(began) < kTickSlice) status = in.tick();
      more = in.inner->ticks < in.until;
    } else if (in.steps > 0) {
      for (; status && !end_ && in.steps > 0 && seconds_since(began) < kTickSlice; --in.steps) status = in.tick();
      more = in.steps > 0;
    } else if (!in.paused) {
      in.due = std::min(in.due + passed * rate * in.speed, kFarthestBehind * rate * in.speed + 1.0);
      for (; status && !end_ && in.due >= 1.0 && seconds_since(began) < kTickSlice; in.due -= 1.0) status = in.tick();
    }
    if (in.still()) in.flush();
  }
  if (!status) {
    in.status.error = status.error().message();
    end_ = true;
  }
  const bool still = in.still();
  moving_ = !still && !(in.realtime && in.paused);
  if (!more || seconds_since(in.shown_ns) > kShowEvery) show(in);
  works.unlock();
  std::unique_lock lock(mutex_);
  if (commands_.empty() && !more) {
    busy_ = false;
    changed_.notify_all();
  }
  if (!more) changed_.wait_for(lock, still ? kIdleTurn : kTurn, [this] { return end_ || !commands_.empty(); });
}

void PlayRun::show(Inside& in) {
  const SessionRun& p = *in.inner;
  const bool still = in.still() && !in.opening;
  const bool figures = seconds_since(in.shown_ns) > kShowEvery || still;
  if (figures) in.shown_ns = now_ns();
  if (still && in.hashed != p.ticks) {
    in.hashed = p.ticks;
    Hash hash = in.journal->hash();
    hash_state(p.world, hash);
    in.hash = fmt::format("{:016x}", hash.value());
    if (const auto found = in.session->findings()) {
      in.findings.clear();
      for (const Note& note : *found) in.findings.push_back(note.message());
    }
  }
  const std::uint64_t tick = in.realtime && p.clock() ? p.clock()->now() + 1 : p.ticks;
  if (const double over = seconds_since(in.paced_ns); over > kPaceOver) {
    in.pace = static_cast<double>(tick - in.paced_tick) / p.world.simulation.touch_rate / over;
    in.paced_ns = now_ns();
    in.paced_tick = tick;
  }
  PlayStatus& shown = in.status;
  if (figures) shown.figures = in.session->figures();
  shown.effectors.clear();
  for (std::size_t i = 0; i < p.effectors.size(); ++i) {
    PlayEffector each;
    each.name = p.effectors[i].name;
    each.tool = !p.world.registry.has<Probe>(p.effectors[i].entity);
    if (const Probe* probe = p.world.registry.find<Probe>(p.effectors[i].entity)) each.radius = probe->radius;
    each.source = p.effectors[i].name == in.moved ? "mouse" : words_of(p.world, p.effectors[i], in.sources[i]);
    if (auto reading = in.session->reading(each.name)) each.reading = *reading;
    each.limited = in.limited[i];
    shown.effectors.push_back(std::move(each));
  }
  shown.devices = {};
  in.view(shown.devices);
  shown.devices.late_ticks = shown.figures.overruns;
  const SoftFigures* const soft = !p.runner->soft().any() ? nullptr
                                  : p.clock()             ? &in.inner->runner->soft().latest()
                                                          : &p.runner->soft().figures();
  shown.surfaces.clear();
  for (const auto& [name, surface] : p.surfaces) shown.surfaces.emplace(name, surface);
  shown.phase = in.opening                       ? PlayPhase::kOpening
                : in.again && p.ticks < in.until ? PlayPhase::kReplaying
                : in.paused || in.again          ? PlayPhase::kPaused
                                                 : PlayPhase::kPlaying;
  for (std::string& note : in.notes) shown.notes.push_back(std::move(note));
  in.notes.clear();
  shown.realtime = in.realtime;
  shown.rate = p.world.simulation.touch_rate;
  shown.tick = tick;
  shown.time = static_cast<double>(tick) / shown.rate;
  shown.pace = in.pace;
  shown.speed = in.speed;
  shown.again = in.again;
  shown.until = in.until;
  shown.soft = soft != nullptr;
  if (soft) shown.soft_ms = soft->step_ms;
  shown.soft_step_ms = 1e3 * p.world.simulation.soft_step;
  shown.hash = still ? in.hash : std::string();
  shown.findings = in.findings;
  in.report();
}

// Devices first, so that none keeps a force during shutdown. The session stays until no picture needs its world.
void PlayRun::close(Inside& in) {
  if (!in.session) return;
  const std::lock_guard works(stands_still_);
  Status ended = in.session->stop();
  for (SessionEffector& effector : in.inner->effectors) in.inner->take_away(effector, EffectorSource::kReleased);
  in.inner->noted = nullptr;
  if (in.journal) in.take_rows();
  if (in.inner->recorder) {
    const Status complete = in.inner->recorder->finish();
    if (ended) ended = complete;
  }
  auto past = std::make_shared<const PlayPast>(in.past());
  in.kept = nullptr;
  in.inner->recorder.reset();
  {
    const std::lock_guard lock(kept->mutex);
    kept->past = std::move(past);
  }
  if (!ended && in.status.error.empty()) in.status.error = ended.error().message();
}

}  // namespace pliant
