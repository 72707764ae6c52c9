#include "engine/session/session_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "components/name_of.h"
#include "components/soft_body.h"
#include "content/keys/sliders.h"
#include "content/level/probe_damage.h"
#include "engine/choice/model_choice.h"
#include "engine/run/driver_limits.h"
#include "engine/run/sources.h"
#include "engine/session/scene_check.h"
#include "runtime/long_work.h"
#include "systems/device/devices.h"
#include "systems/device/hands.h"
#include "systems/prepare_world.h"
#include "systems/safety/safety.h"
#include "systems/soft/under_gravity.h"
#include "systems/touch/model/local_model.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

constexpr std::size_t kMostEdits = 1024;  // capacity

// A Session identifies things by name: names must be unique and not empty.
Status check_names(const std::vector<std::string>& names, const char* what) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name.empty()) return Error{"scene", fmt::format("a {} has no name", what), "give it one"};
    if (!seen.insert(name).second)
      return Error{"scene", fmt::format("two {}s are named `{}`", what, name), "give each a name of its own"};
  }
  return Done{};
}

std::vector<Entity> touchable(const World& world) {
  std::vector<Entity> found;
  for (auto [entity, pose] : world.registry.view<const Pose>()) {
    const Registry& all = world.registry;
    if (all.has<Deformable>(entity) || all.has<SoftBody>(entity) || all.has<RigidBody>(entity)) found.push_back(entity);
  }
  return found;
}

}  // namespace

Error work_stopped() {
  return {"Session::open", "it was stopped by its progress function", "nothing is wrong with the scene"};
}

const World& world_of(const Session& session) {
  return SessionRun::of(session).world;
}

void on_tick(Session& session, std::function<void(Tick)> does) {
  SessionRun::of(session).noted = std::move(does);
}

SessionRun::~SessionRun() {
  if (runner) runner->stop();
  for (SessionEffector& effector : effectors) effector.link.close();
  if (recorder) static_cast<void>(recorder->finish());
}

Status SessionRun::prepare() {
  std::vector<SessionEffector> before = std::move(effectors);
  effectors.clear();
  alive.reset();
  ended = "its restart failed";
  Status made = Done{};
  try {
    made = remake(before);
  } catch (const WorkStopped&) {
    made = work_stopped();
  } catch (const std::exception& thrown) {
    made = Error{"scene", std::string("cannot be made: ") + thrown.what()};
  } catch (...) {
    made =
        Error{"scene", "cannot be made: something that is no std::exception was thrown", "look at what is registered"};
  }
  for (SessionEffector& effector : before) effector.link.close();  // those absent from the new world
  if (made)
    ended = nullptr;
  else
    for (SessionEffector& effector : effectors) effector.link.close();
  return made;
}

Status SessionRun::remake(std::vector<SessionEffector>& before) {
  if (Status s = spawn_world(); !s) return s;
  ticks = overruns = 0;
  history = {};
  history.begun = settings;
  edits = std::make_unique<Ring<Edit>>(kMostEdits);
  places.clear();
  if (Status s = list_named(); !s) return s;
  restore_parameters();
  if (Status s = prepare_spawned(); !s) return s;
  keep_parameters();
  attach_runner();
  size_views();
  alive = std::make_shared<int>();
  if (Status s = give_back_sources(before); !s) return s;
  return send_standing();
}

Status SessionRun::spawn_world() {
  if (Status s = check_scene(scene.level()); !s) return s;
  if (!chosen) {
    begin_part(0.0, 0.4);
    auto choices = choose_models(scene.level());
    if (!choices) return choices.error();
    for (const ModelChoice& choice : *choices) scene.level().notes.push_back(choice.sentence());
    chosen = true;
  }
  notes = scene.level().notes;
  if (sliders.empty()) sliders = sliders_of(scene.level()).value();  // checked; a restart keeps their text
  if (const std::optional<Note> note = undamaged_by_bodies(scene.level())) notes.push_back(note->message());
  begin_part(0.4, 0.7);
  auto spawned = spawn_level(scene.level(), &notes);
  if (!spawned) return spawned.error();
  runner.reset();
  world = std::move(spawned).value();
  return Done{};
}

Status SessionRun::list_named() {
  for (const Entity held : pliant::hands(world)) {
    SessionEffector made;
    made.name = name_of(world, held);
    made.entity = held;
    made.device = own_device(world, held);
    made.prescribed = std::make_unique<TripleBuffer<PrescribedPose>>();
    const HapticDevice& device = world.registry.get<HapticDevice>(made.device);
    made.placed_rotation = device.rotation;
    made.placed_position = place_of(world, held);
    if (device.driver != DriverKind::kNull) made.source = EffectorSource::kLevel;
    effectors.push_back(std::move(made));
  }
  objects.clear();
  object_entities = touchable(world);
  for (const Entity object : object_entities) objects.push_back(name_of(world, object));
  effects.clear();
  for (auto [entity, effect] : world.registry.view<const Effect>())
    if (const auto [it, is_new] = effects.emplace(name_of(world, entity), entity); !is_new) it->second = kNoEntity;
  std::vector<std::string> names;
  for (const SessionEffector& effector : effectors) names.push_back(effector.name);
  if (Status s = check_names(names, "probe or tool"); !s) return s;
  return check_names(objects, "object");
}

void SessionRun::restore_parameters() {
  for (const auto& [name, surface] : surfaces)
    static_cast<DeformableParameters&>(world.registry.get<Deformable>(*find_object(name))) = surface;
  for (const auto& [name, device] : devices)
    static_cast<DeviceParameters&>(world.registry.get<HapticDevice>(find_effector(name)->device)) = device;
  restore_bodies();
}

Status SessionRun::prepare_spawned() {
  begin_part(0.7, 1.0);
  const std::vector<Note> found = tissue_findings(world);
  if (Status s = prepare_world(world); !s) return s;
  for (const Note& note : tissue_findings(world))
    if (std::find(found.begin(), found.end(), note) == found.end()) notes.push_back(note.message());
  for (std::string& sentence : make_orbits(world)) notes.push_back(std::move(sentence));
  return Done{};
}

void SessionRun::keep_parameters() {
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (const Deformable* surface = world.registry.find<Deformable>(object_entities[i]))
      surfaces[objects[i]] = *surface;
  keep_bodies();
  for (const SessionEffector& effector : effectors)
    devices.emplace(effector.name, world.registry.get<HapticDevice>(effector.device));
}

void SessionRun::attach_runner() {
  runner = std::make_unique<Runner>(world);
  TickPart own;
  own.before = [this](Tick tick) { this->before(tick); };
  own.after = [this](Tick tick) { after(tick); };
  own.idle = [this](Tick) { idle(); };
  own.end = [this] { clock_ended(); };
  runner->attach(std::move(own));
  after_pause = false;
  shown = true;
  time = 0.0;
}

void SessionRun::size_views() {
  for (std::vector<EffectorRow>& slot : rows.slots()) slot.assign(effectors.size(), {});
  view.reset(world);
  shapes.clear();
  shapes.resize(objects.size());
  looked = 0;
  size_kept();
  std::vector<TouchEvent> of_the_last_world;
  events->drain(of_the_last_world);
  taken_out.assign(objects.size(), 0);
}

Status SessionRun::give_back_sources(std::vector<SessionEffector>& before) {
  for (SessionEffector& old : before) {
    SessionEffector* const effector = find_effector(old.name);
    if (!effector || old.source == EffectorSource::kLevel || old.source == EffectorSource::kNone) continue;
    if (old.source == EffectorSource::kReleased) {
      take_away(*effector, old.source);
      continue;
    }
    effector->link = std::move(old.link);
    effector->guard = old.guard;
    effector->path = std::move(old.path);
    effector->source = EffectorSource::kNone;
    if (Status s = give(*effector, old.source); !s) return s;
  }
  return Done{};
}

Status SessionRun::stand_still(const char* what) const {
  if (clock()) return Error{what, "the clocks are running", "call Session::stop() first"};
  return Done{};
}

Status SessionRun::may_give(const SessionEffector& effector) const {
  if (replayed) return Error{"`" + effector.name + "`", "is moved by a recording", "call Session::restart() first"};
  if (effector.source == EffectorSource::kNone || effector.source == EffectorSource::kReleased ||
      effector.source == EffectorSource::kLevel)
    return Done{};
  return Error{"`" + effector.name + "`", "has a source already", "call Session::release() first"};
}

Status SessionRun::give(SessionEffector& effector, EffectorSource source) {
  if (effector.source == source && source == EffectorSource::kPose) return Done{};
  if (Status s = may_give(effector); !s) return s;
  HapticDevice& device = world.registry.get<HapticDevice>(effector.device);
  device.path = {};
  device.driver = DriverKind::kExternal;
  device.status = source == EffectorSource::kPath ? DeviceStatus::kReady : DeviceStatus::kLost;
  effector.placed = false;
  effector.source = source;
  if (source == EffectorSource::kPath) {
    device.driver = DriverKind::kScript;
    device.path = world.paths.add(Path(effector.path));
  }
  begin(effector);
  return Done{};
}

Status SessionRun::connect(const std::string& name, std::unique_ptr<Driver> driver, const std::string& id,
                           const std::string& claimed) {
  SessionEffector* const effector = find_effector(name);
  if (!effector) return unknown_effector(name);
  if (Status s = stand_still("Session::connect"); !s) return s;
  const std::string where = "Session::connect `" + name + "`";
  if (!driver) return Error{where, "the driver is null", "give one"};
  if (Status s = may_give(*effector); !s) return s;
  if (Status s = effector->link.connect(std::move(driver), id, where, claimed, effector->guard); !s) return s;
  return give(*effector, EffectorSource::kDriver);
}

void SessionRun::take_away(SessionEffector& effector, EffectorSource source) {
  effector.link.close();
  HapticDevice& device = world.registry.get<HapticDevice>(effector.device);
  device.driver = DriverKind::kNull;
  device.path = {};
  device.status = DeviceStatus::kLost;
  effector.source = source;
  effector.placed = false;
  begin(effector);
}

void SessionRun::begin(SessionEffector& effector) {
  HapticDevice& device = world.registry.get<HapticDevice>(effector.device);
  effector.link.begin(device, effector.placed_rotation, effector.placed_position);
  begin_anew(world, effector.entity);
  effector.renewed = ticks > 0;  // before the first tick there is nothing to lose
  std::string limits;
  for (const std::string& setting : driver_settings(effector.name, device)) limits += setting + "\n";
  note_new_source(effector.entity, {0, EventKind::kNewSource, effector.name, limits, 0, {}});
}

void SessionRun::zero_drivers() noexcept {
  for (SessionEffector& effector : effectors) effector.link.zero();
}

Status SessionRun::start_drivers() {
  for (SessionEffector& effector : effectors)
    if (Status started = effector.link.start(); !started) {
      halt_drivers();
      return started;
    }
  return Done{};
}

void SessionRun::halt_drivers() noexcept {
  for (SessionEffector& effector : effectors) effector.link.halt();
}

void SessionRun::end(const char* why) noexcept {
  ended = why;
  let_go(world, {ticks, 1.0 / world.simulation.touch_rate, time});
  zero_drivers();
  show_let_go();
}

void SessionRun::show_let_go() noexcept {
  for (EffectorRow& row : rows.write()) {
    row = {};
    row.reading.tick = last.index;
    row.reading.time = last.time;
    if (keeps > 0) kept[static_cast<std::size_t>(&row - rows.write().data())]->record(row);
  }
  rows.publish();
}

void SessionRun::clock_ended() noexcept {
  zero_drivers();
  if (!shown) show_let_go();
}

void SessionRun::read_prescribed(SessionEffector& effector, Tick tick) {
  HapticDevice& device = world.registry.get<HapticDevice>(effector.device);
  if (effector.prescribed->acquire()) {
    const PrescribedPose& to = effector.prescribed->read();
    const double since = tick.time - effector.heard_at;
    effector.lasts = clock() && effector.placed ? std::clamp(since, tick.dt, kLongestWay) : tick.dt;
    effector.from = effector.placed ? effector.now : to;
    effector.heard_at = tick.time;
    effector.placed = true;
  }
  if (clock() && tick.time - effector.heard_at > kPrescribedHolds) effector.placed = false;  // it becomes stale
  if (!effector.placed) return;
  const PrescribedPose& to = effector.prescribed->read();
  const double share = std::min(1.0, (tick.time - effector.heard_at + tick.dt) / effector.lasts);
  effector.now.position = share < 1.0 ? glm::mix(effector.from.position, to.position, share) : to.position;
  effector.now.rotation = share < 1.0 ? glm::slerp(effector.from.rotation, to.rotation, share) : to.rotation;
  if (Probe* const probe = world.registry.find<Probe>(effector.entity)) probe->hold = to.hold;
  device.position = effector.now.position;
  device.rotation = effector.now.rotation;
  device.sensed_at = tick.time;
  device.status = DeviceStatus::kReady;
}

void SessionRun::before(Tick tick) {
  last = tick;
  shown = false;
  Edit edit;
  while (edits->pop(edit)) {
    apply_edit(world, edit);
    if (recorder && edit.number > 0) recorder->stamp(edit.number, tick.index);
  }
  for (SessionEffector& effector : effectors) {
    HapticDevice& device = world.registry.get<HapticDevice>(effector.device);
    if (after_pause) forget(effector);
    if (effector.source == EffectorSource::kPose) read_prescribed(effector, tick);
    if (effector.source == EffectorSource::kDriver) effector.link.read(device, tick);
    if (effector.source == EffectorSource::kPath) device.status = DeviceStatus::kReady;
    if (effector.renewed) device.status = DeviceStatus::kLost;
    effector.renewed = false;
  }
}

// After a pause the previous pose is old, although little simulated time has passed: the gate would open on it.
void SessionRun::forget(SessionEffector& effector) {
  if (effector.source != EffectorSource::kPose && effector.source != EffectorSource::kDriver) return;
  effector.placed = false;
  effector.link.forget();
  world.registry.get<HapticDevice>(effector.device).status = DeviceStatus::kLost;
}

void SessionRun::idle() {
  after_pause = true;
  for (SessionEffector& effector : effectors)
    if (effector.link) effector.link.idle();
}

}  // namespace pliant
