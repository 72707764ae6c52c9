#include "editor/play/play.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "editor/play/live_edits.h"
#include "editor/play/rendered.h"
#include "editor/play/run_findings.h"
#include "editor/play/scene_view.h"
#include "systems/safety/safety.h"

namespace pliant {
namespace {

bool any_driver(const std::map<std::string, PlaySource>& sources) {
  return std::any_of(sources.begin(), sources.end(),
                     [](const auto& each) { return each.second.kind == PlaySource::Kind::kDriver; });
}

// Whether it is another document, not an edit of this one.
bool unrelated(const State& before, const State& after) {
  if (before.nodes.empty()) return false;
  std::set<const void*> parts;
  for (const auto& node : before.nodes) parts.insert(node.get());
  for (const auto& mesh : before.meshes) parts.insert(mesh.get());
  const auto known = [&](const auto& part) { return parts.contains(part.get()); };
  return std::none_of(after.nodes.begin(), after.nodes.end(), known) &&
         std::none_of(after.meshes.begin(), after.meshes.end(), known);
}

}  // namespace

Play::~Play() {
  if (run_) run_->end();
  if (next_) next_->end();
}

bool Play::ready() const {
  return on() && !next_ && status_.phase != PlayPhase::kOpening && status_.phase != PlayPhase::kReplaying &&
         (!show || run_->pictured());
}

PlayOptions Play::options() {
  PlayOptions made;
  made.level = [state = editor_.state(), folder = editor_.document.folder(), file = editor_.document.file(),
                unsaved = editor_.document.unsaved_scripts()]() -> Result<Level> {
    return level_to_play(state, folder, file, unsaved);
  };
  for (const auto& [name, source] : sources) made.sources.emplace_back(name, source);
  // A path with unsaved changes is played as in the document.
  const auto unsaved = editor_.document.unsaved_scripts();
  for (const auto& each : editor_.state().nodes) {
    const LevelNode& node = each->node;
    if (!node.probe && !node.handle) continue;
    const DocumentNode* const device = editor_.state().find(node.probe ? node.probe_device : node.handle->device);
    if (!device || !device->node.device || device->node.device->driver != DriverKind::kScript) continue;
    const auto script = unsaved.find(device->node.device->file);
    const auto chosen = sources.find(node.name);
    if (script == unsaved.end() || (chosen != sources.end() && chosen->second.kind != PlaySource::Kind::kLevel))
      continue;
    std::erase_if(made.sources, [&](const auto& other) { return other.first == node.name; });
    made.sources.emplace_back(node.name, PlaySource{PlaySource::Kind::kScript, script->first,
                                                    std::make_shared<const Path>(path_of(*script->second)), 0.0});
  }
  for (const auto& each : editor_.state().nodes)
    if (each->node.device && answers.allows(editor_.document.file(), each->node.device->id))
      made.allowed.insert(each->node.device->id);
  made.mouse_probe = mouse_probe;
  made.repeats = true;
  made.realtime = realtime;
  made.speed = speed;
  made.paused = paused_;
  made.view = editor_.camera.viewpoint();
  return made;
}

std::vector<LevelRequest> Play::asks() const {
  Level level;
  for (const auto& each : editor_.state().nodes) level.nodes.push_back(each->node);
  std::vector<LevelRequest> all = device_requests(level);
  std::erase_if(all, [&](const LevelRequest& asked) {
    const auto source = sources.find(asked.moves);
    const bool other = source != sources.end() && source->second.kind != PlaySource::Kind::kLevel;
    return !asked.used || other || asked.request.refused.empty() || answers.allows(editor_.document.file(), asked.id);
  });
  return all;
}

void Play::start() {
  if (on()) return;
  paused_ = false;
  said_later_ = false;
  said_ = 0;
  past_.reset();
  status_ = {};
  for (auto& [name, source] : sources) source.from = 0.0;
  if (any_driver(sources) && !realtime) {
    realtime = true;
    editor_.say("a device feels in real time only, so the level plays in real time");
  }
  PlayOptions made = options();
  made.shown = static_cast<bool>(show);
  if (!traces_.empty() && std::any_of(traces_.begin(), traces_.end(), [](const PlayTrace& trace) {
        return std::any_of(trace.samples.begin(), trace.samples.end(), [](const PlaySample& s) { return s.touching; });
      }))
    before_ = std::move(traces_);
  traces_.clear();
  editor_.run_findings.clear();
  run_ = std::make_shared<PlayRun>(std::move(made));
  on_stage_ = false;
  editor_.playing = true;
}

void Play::stop() {
  if (!on()) return;
  run_->end();
  kept_ = run_->kept;
  if (next_) next_->end();
  if (show && on_stage_) show(nullptr);
  run_.reset();  // the stage keeps the last reference, and releases it after its picture
  next_.reset();
  past_.reset();
  on_stage_ = false;
  paused_ = false;
  status_.phase = PlayPhase::kEnded;
  status_.again = false;
  editor_.playing = false;
}

void Play::restart() {
  if (!on()) return;
  stop();
  start();
}

void Play::pause(bool paused) {
  if (!on()) return;
  if (next_) return;
  if (!paused && status_.again) {  // continue from here
    const double now = status_.time;
    if (realtime && !status_.realtime) editor_.say("it goes on in lockstep; press Restart for real time");
    run_->go_on();
    end_past(traces_, now);
    past_.reset();
  } else {
    run_->pause(paused);
  }
  paused_ = paused;
}

void Play::end_past(std::vector<PlayTrace>& traces, double time) {
  for (PlayTrace& trace : traces)
    while (!trace.samples.empty() && trace.samples.back().time >= time - 1e-9) trace.samples.pop_back();
}

void Play::toggle() {
  if (on())
    pause(!paused_);
  else
    start();
}

void Play::step(std::uint64_t ticks) {
  if (!may_step() || next_) return;
  if (status_.again) {
    const double now = status_.time;
    run_->go_on();
    run_->pause(true);
    end_past(traces_, now);
    past_.reset();
  }
  run_->step(ticks);
}

void Play::set_speed(double to) {
  speed = to;
  if (run_) run_->set_speed(to);
}

void Play::set_source(const std::string& effector, const PlaySource& source) {
  sources[effector] = source;
  if (!run_) return;
  if (source.kind == PlaySource::Kind::kDriver) {
    editor_.say("a device takes over at the next Play");
    return;
  }
  sources[effector].from = status_.time;
  run_->set_source(effector, sources[effector]);
}

void Play::order(const DeviceOrders& orders) {
  if (!run_ || !orders.any()) return;
  run_->order(orders);
  if (orders.stop_all) editor_.say("emergency stop: no device has force until it is armed", Severity::kWarning);
}

double Play::oldest() const {
  double oldest = latest();
  for (const PlayTrace& trace : traces_)
    if (!trace.samples.empty()) oldest = std::min(oldest, trace.samples.front().time);
  return oldest;
}

double Play::latest() const {
  double latest = past_ ? 0.0 : status_.time;
  for (const PlayTrace& trace : traces_)
    if (!trace.samples.empty()) latest = std::max(latest, trace.samples.back().time);
  return latest;
}

double Play::progress() const {
  const PlayStatus status = next_ ? next_->status() : status_;
  if (!status.again || status.until == 0) return next_ ? 0.0 : 1.0;
  return std::min(1.0, static_cast<double>(status.tick) / static_cast<double>(status.until));
}

void Play::go_to(double time) {
  if (!on()) return;
  if (!past_) {
    run_->pause(true);
    past_ = run_->past();
    take_samples();
    paused_ = true;
    if (!past_ || past_->ticks.empty()) {
      past_.reset();
      return;
    }
    if (past_->ticks.size() >= PlayPast::kMostTicks)
      editor_.say(fmt::format("only the first {} ticks of a run can be gone back to", PlayPast::kMostTicks));
  }
  going_to_ = std::clamp(time, 0.0, static_cast<double>(past_->ticks.back() + 1) / status_.rate);
  const auto tick = static_cast<std::uint64_t>(std::llround(going_to_ * status_.rate));
  const auto target = static_cast<std::uint64_t>(std::lower_bound(past_->ticks.begin(), past_->ticks.end(), tick) -
                                                 past_->ticks.begin());
  PlayRun* const under_way = next_ ? next_.get() : status_.again ? run_.get() : nullptr;
  if (under_way && under_way->status().tick <= target) {
    under_way->go_to(target);
    return;
  }
  PlayOptions made = options();
  made.past = past_;
  made.until = target;
  made.paused = true;
  if (next_) next_->end();
  said_next_ = 0;
  next_ = std::make_shared<PlayRun>(std::move(made));
}

void Play::put_on_stage() {
  if (!show || on_stage_ || !run_->opened()) return;
  on_stage_ = true;
  show([run = run_] { return std::make_unique<SceneView>(run); });
}

void Play::take_samples() {
  run_->take_samples(taken_);
  if (traces_.size() != taken_.size()) traces_.resize(taken_.size());
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    PlayTrace& trace = traces_[i];
    if (i < status_.effectors.size()) {
      trace.name = status_.effectors[i].name;
      trace.radius = status_.effectors[i].radius;
    }
    // Samples of a repeated past are there already.
    for (const PlaySample& sample : taken_[i])
      if (trace.samples.empty() || sample.time > trace.samples.back().time) {
        trace.samples.push_back(sample);
        trace.touched += sample.touching;
        trace.gated += (sample.limited >> static_cast<unsigned>(SafetyLimit::kGated)) & 1u;
      }
    while (!trace.samples.empty() && trace.samples.back().time - trace.samples.front().time > PlayTrace::kKept)
      trace.samples.pop_front();
  }
}

void Play::update() {
  if (!on()) return;
  if (next_) {
    const PlayStatus ahead = next_->status();
    if (ahead.phase == PlayPhase::kPaused && ahead.tick >= ahead.until) {
      run_->end();
      run_ = std::move(next_);
      next_.reset();
      said_ = ahead.notes.size();  // already reported by the first run
      on_stage_ = false;
    } else if (ahead.phase == PlayPhase::kEnded) {
      editor_.say("going back failed: " + ahead.error, Severity::kError);
      next_.reset();
    }
  }
  status_ = run_->status();
  realtime |= status_.realtime;  // required by a device of the level
  for (; said_ < status_.notes.size(); ++said_) editor_.say(status_.notes[said_]);
  take_samples();
  note_findings();
  put_on_stage();
  if (status_.phase != PlayPhase::kEnded) return;
  editor_.say(status_.error.empty() ? "the level has stopped playing" : status_.error, Severity::kError);
  stop();
}

void Play::note_findings() {
  editor_.run_findings.clear();
  for (const RunFinding& each : run_findings(editor_.state(), status_, traces_)) {
    const DocumentNode* const node = editor_.state().find(each.effector);
    if (node && !each.text.empty()) editor_.run_findings.push_back({{Severity::kWarning, "", each.text}, node->id, {}});
  }
}

std::shared_ptr<const PlayPast> Play::past() {
  if (on()) return ready() ? run_->past() : nullptr;
  if (!kept_) return nullptr;
  const std::lock_guard lock(kept_->mutex);
  return kept_->past;
}

void Play::changed(const State& before, const State& after) {
  if (!on() && !kept_) return;
  if (unrelated(before, after)) {
    stop();
    kept_.reset();
    status_ = {};
    sources.clear();
    traces_.clear();
    before_.clear();
    editor_.run_findings.clear();
    return;
  }
  if (!on()) return;
  const LiveEdits edits = live_edits(before, after);
  for (const LiveEdit& edit : edits.now) run_->set(edit.object, edit.key, edit.value);
  if (!edits.later || said_later_) return;
  said_later_ = true;
  editor_.say("what has just been changed takes effect at the next Play");
}

}  // namespace pliant
