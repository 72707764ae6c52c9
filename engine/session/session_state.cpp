// States of lockstep runs (Session::save_state): a session stores its inputs and replays them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "content/files/limits.h"
#include "engine/choice/model_choice.h"
#include "engine/run/scene_hash.h"
#include "engine/session/scene_check.h"
#include "engine/session/session_run.h"
#include "systems/device/devices.h"
#include "systems/device/softening.h"
#include "systems/safety/safety.h"

namespace pliant {
namespace {

constexpr const char* kRestore = "Session::restore_state";

HistoryPose saved(const PrescribedPose& pose) {
  return {pose.position, pose.rotation, 0.0, true, true, false, 0.0};
}
PrescribedPose prescribed(const HistoryPose& pose) {
  return {pose.position, pose.rotation};
}

std::uint64_t hash_of(const Path& path) {
  Hash hash;
  hash.add(static_cast<std::uint8_t>(path.turns));
  hash.add(static_cast<std::uint8_t>(path.repeats));
  for (const PathRow& row : path.rows)
    for (const double v : {row.time, row.position.x, row.position.y, row.position.z, row.rotation.w, row.rotation.x,
                           row.rotation.y, row.rotation.z})
      hash.add(v);
  return hash.value();
}

// Only devices that sense a person become stale (systems/safety).
bool is_ready(const HapticDevice& device, double now) {
  const bool sensed = device.driver == DriverKind::kExternal || device.driver == DriverKind::kMouse;
  return device.status == DeviceStatus::kReady && !(sensed && now - device.sensed_at > kStaleAfter);
}

// The scene with another scene's objects appended; `names` receives theirs.
Result<Scene> with_more(const Scene& scene, const Scene& more, std::vector<std::string>& names) {
  const char* const kAdd = "Session::add";
  Scene merged = scene;
  Scene chosen = more;
  if (auto choices = choose_models(chosen.level()); !choices) return choices.error();
  Level &to = merged.level(), &from = chosen.level();
  const auto meshes = static_cast<std::int32_t>(to.meshes.size()), nodes = static_cast<std::int32_t>(to.nodes.size());
  for (LevelMesh& mesh : from.meshes) {
    mesh.source = -1;
    for (Primitive& primitive : mesh.primitives) primitive.material = primitive.source = -1;
    to.meshes.push_back(std::move(mesh));
  }
  for (LevelNode& node : from.nodes) {
    if (node.probe || node.device || node.handle)
      return Error{kAdd, "`" + node.name + "` is a probe, a device or a tool", "open a session with it"};
    if (node.effect)
      return Error{kAdd, "`" + node.name + "` is an effect", "open a session with it, and set() its strength"};
    if (node.motion) return Error{kAdd, "`" + node.name + "` follows a motion", "open a session with it"};
    if (node.deformable || node.soft_body || node.rigid_body) names.push_back(node.name);
    node.source = -1;
    if (node.mesh >= 0) node.mesh += meshes;
    if (node.parent >= 0) node.parent += nodes;
    for (std::int32_t& child : node.children) child += nodes;
    to.nodes.push_back(std::move(node));
  }
  if (names.empty()) return Error{kAdd, "the scene has no object", "add one with Scene::add_surface"};
  return merged;
}

}  // namespace

void SessionRun::note_history(Tick tick) {
  if (history.lacking) return;
  if (replayed) {
    history = {};
    history.lacking = "its poses are a recording's; replay that again instead";
    return;
  }
  const std::size_t bytes = (ticks + 1) * std::max<std::size_t>(1, effectors.size()) * sizeof(HistoryPose) +
                            history.events.size() * sizeof(RecordedEvent);
  if (bytes > most(limits::kJournal)) {
    history = {};
    history.lacking = "it has run for too long since its time 0 to be run again; call Session::restart() now and then";
    return;
  }
  for (const SessionEffector& effector : effectors) {
    const HapticDevice& device = world.registry.get<HapticDevice>(effector.device);
    const SafetyState* const safety = safety_of(world, effector.entity);
    history.poses.push_back({device.position, device.rotation, device.sensed_at, is_ready(device, tick.time),
                             !safety || safety->felt, device.grips, std::clamp(device.grip, 0.0, 1.0)});
  }
}

SavedState SessionRun::saved_state() const {
  SavedState state;
  state.rate = world.simulation.touch_rate;
  state.scene = scene_hash(scene.level());
  state.ticks = ticks;
  state.history = history;
  for (const SessionEffector& effector : effectors) {
    state.effectors.push_back(effector.name);
    SavedSource source;
    source.kind = static_cast<std::uint8_t>(effector.source);
    if (effector.source == EffectorSource::kPath) source.path = hash_of(effector.path);
    if (effector.source == EffectorSource::kPose) {
      source.placed = effector.placed;
      source.waits = effector.prescribed->unseen();
      source.heard_at = effector.heard_at;
      source.lasts = effector.lasts;
      source.from = saved(effector.from);
      source.now = saved(effector.now);
      source.to = saved(effector.set);
    }
    state.sources.push_back(source);
  }
  return state;
}

// Replays the inputs tick by tick. The caller has set sources and drivers aside.
Status SessionRun::run_again(SavedState state) {
  const double dt = 1.0 / world.simulation.touch_rate;
  const std::vector<RecordedEvent> events = std::move(state.history.events);
  history = {};
  history.begun = settings;
  std::size_t done = 0;
  const auto perform_until = [&](std::uint64_t tick) -> Status {
    for (; done < events.size() && events[done].tick <= tick; ++done)
      if (Status s = perform(events[done]); !s) return s;
    return Done{};
  };
  for (ticks = 0; ticks < state.ticks; ++ticks) {
    const Tick tick{ticks, dt, static_cast<double>(ticks) * dt};
    if (Status s = perform_until(ticks); !s) return s;
    for (std::size_t i = 0; i < effectors.size(); ++i) {
      const HistoryPose& pose = state.history.poses[ticks * effectors.size() + i];
      HapticDevice& device = world.registry.get<HapticDevice>(effectors[i].device);
      device.position = pose.position;
      device.rotation = pose.rotation;
      device.sensed_at = pose.sensed_at;
      device.grips = pose.grips, device.grip = pose.grip;
      device.status = pose.ready ? DeviceStatus::kReady : DeviceStatus::kLost;
      if (SafetyState* const safety = safety_of(world, effectors[i].entity)) safety->felt = pose.felt;
    }
    runner->step(tick);
    time = tick.time + dt;
  }
  history.poses = std::move(state.history.poses);
  return perform_until(ticks);
}

// The current sources take over at the restored places.
void SessionRun::go_on(const SavedState& state, std::vector<EffectorSource>& sources, std::vector<DriverLink>& links,
                       std::vector<HapticDevice>& before) {
  for (std::size_t i = 0; i < effectors.size(); ++i) {
    SessionEffector& effector = effectors[i];
    const SavedSource& was = state.sources[i];
    HapticDevice& device = world.registry.get<HapticDevice>(effector.device);
    effector.source = sources[i];
    effector.link = std::move(links[i]);
    device.driver = before[i].driver;
    device.path = before[i].path;
    const bool posed = was.kind == static_cast<std::uint8_t>(EffectorSource::kPose);
    if (posed && (effector.source == EffectorSource::kNone || effector.source == EffectorSource::kReleased ||
                  effector.source == EffectorSource::kLevel)) {
      effector.source = EffectorSource::kPose;  // the next poses that are set continue from here
      device.driver = DriverKind::kExternal;
      device.path = {};
    }
    const bool same_kind = static_cast<std::uint8_t>(effector.source) == was.kind;
    if (posed && same_kind) {
      effector.placed = was.placed;
      effector.heard_at = was.heard_at;
      effector.lasts = was.lasts;
      effector.from = prescribed(was.from);
      effector.now = prescribed(was.now);
      effector.set = effector.prescribed->write() = prescribed(was.to);
      effector.prescribed->publish();
      if (!was.waits) effector.prescribed->acquire();
      continue;
    }
    const bool goes_on = same_kind && effector.source != EffectorSource::kDriver &&
                         (effector.source != EffectorSource::kPath || hash_of(effector.path) == was.path);
    if (!goes_on && (ticks > 0 || effector.source == EffectorSource::kDriver)) begin(effector);
  }
}

Result<std::vector<std::uint8_t>> Session::save_state() const {
  const SessionRun& p = *run_;
  if (Status s = p.stand_still("Session::save_state"); !s) return s.error();
  if (p.ended || p.history.lacking)
    return Error{"Session::save_state",
                 std::string("no state can be saved: ") + (p.history.lacking ? p.history.lacking : p.ended)};
  return pack_state(p.saved_state());
}

Status Session::restore_state(const std::vector<std::uint8_t>& bytes) {
  SessionRun& p = *run_;
  if (Status s = p.stand_still(kRestore); !s) return s;
  if (p.recorder) return Error{kRestore, "a recording is under way", "call Session::end_recording() first"};
  if (p.replayed) return Error{kRestore, "a recording is replayed", "call Session::restart() first"};
  auto state = unpack_state(bytes);
  if (!state) return state.error();
  if (state->scene != scene_hash(p.scene.level()) || state->rate != p.world.simulation.touch_rate ||
      state->effectors != effectors())
    return Error{kRestore, "the state is another scene's", "restore it in a session of the scene that it was saved in"};
  return p.go_back(std::move(*state));
}

Status Session::add(const Scene& more) {
  SessionRun& p = *run_;
  const char* const kAdd = "Session::add";
  if (p.clock())
    return Error{kAdd, "the clocks are running", "open the session with it, and take it out before start()"};
  if (p.recorder) return Error{kAdd, "a recording is under way", "call Session::end_recording() first"};
  if (p.replayed) return Error{kAdd, "a recording is replayed", "call Session::restart() first"};
  if (p.ended || p.history.lacking)
    return Error{kAdd, std::string("nothing can be added: ") + (p.history.lacking ? p.history.lacking : p.ended)};
  std::vector<std::string> names;
  auto merged = with_more(p.scene, more, names);
  if (!merged) return merged.error();
  auto trial = Session::open(*merged);  // errors are reported before anything changes
  if (!trial) return trial.error();
  SavedState state = p.saved_state();
  std::vector<RecordedEvent> events;
  for (const std::string& name : names) events.push_back({0, EventKind::kPresent, name, {}, 0, {0.0}});
  events.insert(events.end(), state.history.events.begin(), state.history.events.end());
  for (const std::string& name : names) events.push_back({p.ticks, EventKind::kPresent, name, {}, 0, {1.0}});
  state.history.events = std::move(events);
  p.scene = std::move(*merged);
  return p.go_back(std::move(state));
}

Status SessionRun::go_back(SavedState state) {
  zero_drivers();
  settings.clear();
  surfaces.clear();
  devices.clear();
  bodies.clear();
  standing.clear();
  if (Status s = prepare(); !s) return s;
  if (!state.history.begun.empty()) {
    std::vector<std::string> begun;
    for (const auto& [key, value] : state.history.begun) begun.push_back(key + "=" + value);
    const std::vector<Error> refused = apply_settings(begun, Setting::kKeep);
    if (!refused.empty()) {
      end("a state could not be restored");
      return Error{kRestore, "a setting of the state is none of this scene's: " + refused.front().message(),
                   "save it again"};
    }
    if (Status s = prepare(); !s) return s;
  }
  std::vector<EffectorSource> sources;
  std::vector<DriverLink> links;
  std::vector<HapticDevice> before_it;
  for (SessionEffector& effector : effectors) {
    HapticDevice& device = world.registry.get<HapticDevice>(effector.device);
    sources.push_back(std::exchange(effector.source, EffectorSource::kNone));
    links.push_back(std::move(effector.link));
    before_it.push_back(device);
    device.driver = DriverKind::kNull;
    device.path = {};
    device.can = kNoDriver;
    device.workspace = 1.0;
    effector.renewed = false;
  }
  const std::size_t kept_ticks = std::exchange(keeps, 0);
  const std::function<void(Tick)> noted_by = std::exchange(noted, {});
  restoring = true;
  Status done = Done{};
  try {
    done = run_again(state);
  } catch (const std::exception& thrown) {
    done = Error{kRestore, std::string("stopped by an exception: ") + thrown.what(), "please report it"};
  }
  restoring = false;
  keeps = kept_ticks;
  noted = noted_by;
  go_on(state, sources, links, before_it);
  rows.acquire();
  if (!done) end("a state could not be restored");
  return done;
}

}  // namespace pliant
