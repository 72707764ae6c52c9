// Session's functions (pliant/session.h) for sources, time and parameters. Output is in session_frame.cpp.
#include "pliant/session.h"

#include <fmt/format.h>

#include <limits>

#include "devices/choose.h"
#include "devices/wrappers/chain.h"
#include "engine/run/sources.h"
#include "engine/session/scene_check.h"
#include "engine/session/session_run.h"
#include "runtime/long_work.h"
#include "systems/safety/safety.h"
#include "systems/soft/soft_state.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

bool all_finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

Session::Session(std::unique_ptr<SessionRun> run) : run_(std::move(run)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

Result<Session> Session::open(const Scene& scene, const OpenProgress& progress) {
  auto parts = std::make_unique<SessionRun>(scene);
  const WatchedWork watch(progress);
  if (Status s = parts->prepare(); !s) return s.error();
  if (progress && !progress(1.0, "ready")) return work_stopped();
  return Session(std::move(parts));
}

const std::vector<std::string>& Session::notes() const& {
  return run_->notes;
}
std::vector<std::string> Session::notes() && {
  return std::move(run_->notes);
}
const std::vector<std::string>& Session::objects() const& {
  return run_->objects;
}
std::vector<std::string> Session::objects() && {
  return run_->objects;
}
std::vector<std::string> Session::effectors() const {
  std::vector<std::string> names;
  for (const SessionEffector& effector : run_->effectors) names.push_back(effector.name);
  return names;
}

Status Session::move(const std::string& name, dvec3 position, dquat rotation) {
  SessionEffector* const effector = run_->find_effector(name);
  if (!effector) return run_->unknown_effector(name);
  if (!all_finite(position) || !plausible_rotation(rotation))
    return Error{"Session::move `" + name + "`", "the pose is not finite or its rotation is not of unit length"};
  if (effector->source != EffectorSource::kPose) {
    if (Status s = run_->stand_still("Session::move"); !s)
      return Error{"Session::move `" + name + "`", "it had no pose before start()", "give it one first"};
    if (Status s = run_->give(*effector, EffectorSource::kPose); !s) return s;
  }
  effector->set = effector->prescribed->write() = {position, rotation / glm::length(rotation), effector->hold};
  effector->prescribed->publish();
  return Done{};
}

Status Session::follow(const std::string& name, Path path) {
  SessionEffector* const effector = run_->find_effector(name);
  if (!effector) return run_->unknown_effector(name);
  if (Status s = run_->stand_still("Session::follow"); !s) return s;
  if (path.rows.empty()) return Error{"Session::follow `" + name + "`", "the path has no rows", "give it one at least"};
  double before = -std::numeric_limits<double>::infinity();
  for (PathRow& row : path.rows) {
    if (!all_finite(row.position) || !(row.time > before) || !std::isfinite(row.time))
      return Error{"Session::follow `" + name + "`", "times must ascend and positions must be finite"};
    before = row.time;
    if (!path.turns)
      row.rotation = dquat(1, 0, 0, 0);
    else if (plausible_rotation(row.rotation))
      row.rotation /= glm::length(row.rotation);
    else
      return Error{"Session::follow `" + name + "`", "a rotation is not of unit length", "normalise it"};
  }
  Path kept = std::move(effector->path);
  effector->path = std::move(path);
  Status given = run_->give(*effector, EffectorSource::kPath);
  if (!given) effector->path = std::move(kept);
  return given;
}

Status Session::orbit(const std::string& name) {
  SessionEffector* const effector = run_->find_effector(name);
  if (!effector) return run_->unknown_effector(name);
  if (Status s = run_->stand_still("Session::orbit"); !s) return s;
  const auto index = static_cast<unsigned>(effector - run_->effectors.data());
  Path path = orbit_of(run_->world, effector->entity, index);
  if (path.rows.empty())
    return Error{"Session::orbit `" + name + "`", "found no deformable surface", "add one with Scene::add_surface"};
  return follow(name, std::move(path));
}

Status Session::connect(const std::string& name, const std::string& driver) {
  auto chosen = choose_device(driver, list_devices());
  if (!chosen) return chosen.error();
  if (chosen->id.empty())
    return Error{"Session::connect `" + name + "`", "the mouse is the window's: move the probe with Session::move"};
  auto made = make_device(chosen->id);
  if (!made) return made.error();
  return run_->connect(name, std::move(made->driver), made->id, chosen->id);
}

Status Session::connect(const std::string& name, std::unique_ptr<Driver> driver, const std::string& id) {
  return run_->connect(name, std::move(driver), id, {});
}

Status Session::release(const std::string& name) {
  SessionEffector* const effector = run_->find_effector(name);
  if (!effector) return run_->unknown_effector(name);
  if (Status s = run_->stand_still("Session::release"); !s) return s;
  if (run_->replayed) return Error{"`" + name + "`", "is moved by a recording", "call Session::restart() first"};
  run_->take_away(*effector, EffectorSource::kReleased);
  return Done{};
}

Status Session::step(std::uint64_t ticks) {
  if (Status s = run_->stand_still("Session::step"); !s) return s;
  SessionRun& p = *run_;
  if (p.ended) return Error{"Session::step", std::string(p.ended), "call Session::restart() first"};
  for (const SessionEffector& effector : p.effectors)
    if (Status s = effector.link.may_step(); !s) return s.error().at("Session::step `" + effector.name + "`");
  const double dt = 1.0 / p.world.simulation.touch_rate;
  Status done = Done{};
  try {
    for (std::uint64_t i = 0; i < ticks; ++i) {
      if (p.replayed && p.ticks >= p.replayed->ticks.size()) {
        done = Error{"Session::step", fmt::format("all {} ticks of the recording have run", p.replayed->ticks.size()),
                     "call Session::restart()"};
        break;
      }
      const Tick tick = p.replay ? p.replay->begin_tick(p.ticks) : Tick{p.ticks, dt, static_cast<double>(p.ticks) * dt};
      if (p.replay) p.replay_events(tick.index);
      p.runner->step(tick);
      p.note_history(tick);
      if (p.recorder && p.ticks % (p.recorder->room() / 2) == 0) p.recorder->drain();
      ++p.ticks;
      p.time = tick.time + dt;
    }
  } catch (const std::exception& thrown) {
    p.end("it was stopped by an exception");
    done = Error{"Session::step", std::string("stopped by an exception: ") + thrown.what(),
                 "please report it with the scene"};
  } catch (...) {
    p.end("it was stopped by an exception");
    done = Error{"Session::step", "stopped by an exception of an unknown kind", "please report it with the scene"};
  }
  p.rows.acquire();
  if (p.recorder) p.recorder->drain();
  return done;
}

Status Session::start() {
  if (Status s = run_->stand_still("Session::start"); !s) return s;
  SessionRun& p = *run_;
  if (p.ticks > 0) return Error{"Session::start", "it has run before", "call Session::restart() first"};
  if (p.ended) return Error{"Session::start", std::string(p.ended), "call Session::restart() first"};
  if (p.replayed) return Error{"Session::start", "a replay runs in lockstep", "call Session::step()"};
  if (Status s = p.start_drivers(); !s) return s;
  p.ended = "it has run in real time";
  p.history = {};
  p.history.lacking = "it has run in real time, whose steps fall otherwise every time";
  if (p.recorder) p.recorder->start();
  Status started = p.runner->start(std::numeric_limits<std::uint64_t>::max());
  if (started) return started;
  p.halt_drivers();
  p.end("its clocks did not start");
  Error error = started.error().at("Session::start");
  error.cure += error.cure.empty() ? "call Session::restart()" : ", then call Session::restart()";
  return error;
}

Status Session::pause(bool paused) {
  if (!run_->clock()) return Error{"Session::pause", "the clocks do not run", "call Session::start() first"};
  run_->runner->pause(paused);
  return Done{};
}

bool Session::running() const {
  return run_->clock() && !run_->clock()->done();
}

Status Session::stop() {
  SessionRun& p = *run_;
  if (!p.clock()) return Done{};
  p.runner->stop();
  p.halt_drivers();
  p.rows.acquire();
  p.ticks = p.runner->reached() + 1;
  p.time = static_cast<double>(p.ticks) / p.world.simulation.touch_rate;
  p.overruns = p.runner->overruns();
  if (p.runner->error()) return *p.runner->error();
  return Done{};
}

Status Session::restart() {
  Status stopped = stop();
  run_->zero_drivers();
  if (run_->recorder) {
    const Status ended = end_recording();
    if (stopped && !ended) stopped = ended;
  }
  run_->replay.reset();
  run_->replayed.reset();
  if (Status s = run_->prepare(); !s) return s;
  return stopped;
}

double Session::time() const {
  if (!run_->clock()) return run_->time;
  return static_cast<double>(run_->clock()->now()) / run_->world.simulation.touch_rate;
}

}  // namespace pliant
