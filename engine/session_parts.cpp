#include "engine/session_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "components/soft_body.h"
#include "engine/scene_check.h"
#include "engine/sources.h"
#include "systems/device/hands.h"
#include "systems/schedule.h"
#include "systems/soft/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/touch/local_model.h"
#include "systems/touch/prepare.h"
#include "systems/touch/touch_state.h"

namespace pliant {
namespace {

constexpr std::size_t kMostEdits = 256;  // that wait for a tick

std::string name_of(const World& world, Entity entity) {
  const Name* name = world.registry.find<Name>(entity);
  return name ? name->value : std::string();
}

// Names are how a Session is asked: each once, and not empty.
Status check_names(const std::vector<std::string>& names, const char* what) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name.empty()) return Error{"scene", fmt::format("a {} has no name; give it one", what)};
    if (!seen.insert(name).second)
      return Error{"scene", fmt::format("two {}s are named `{}`; give each a name of its own", what, name)};
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

Session::Parts::~Parts() {
  if (clock) clock->stop();
  for (SessionHand& hand : hands) close_driver(hand);
  if (recorder) static_cast<void>(recorder->finish());
}

Status Session::Parts::prepare() {
  notes = scene.level().notes;
  if (Status s = check_scene(scene.level()); !s) return s;
  auto spawned = spawn_level(scene.level(), &notes);
  if (!spawned) return spawned.error();
  clock.reset();
  soft.reset();
  world = std::move(spawned).value();
  std::vector<SessionHand> before = std::move(hands);
  hands.clear();
  for (const Entity hand : pliant::hands(world)) {
    SessionHand made;
    made.name = name_of(world, hand);
    made.entity = hand;
    made.device = own_device(world, hand);
    made.told = std::make_unique<TripleBuffer<ToldPose>>();
    const HapticDevice& device = world.registry.get<HapticDevice>(made.device);
    if (device.driver != DriverKind::kNull) made.source = HandSource::kLevel;
    hands.push_back(std::move(made));
  }
  objects.clear();
  object_entities = touchable(world);
  for (const Entity object : object_entities) objects.push_back(name_of(world, object));
  std::vector<std::string> names;
  for (const SessionHand& hand : hands) names.push_back(hand.name);
  if (Status s = check_names(names, "probe or tool"); !s) return s;
  if (Status s = check_names(objects, "object"); !s) return s;

  for (const auto& [name, surface] : surfaces)  // before a restart
    static_cast<DeformableParameters&>(world.registry.get<Deformable>(*find_object(name))) = surface;
  for (const auto& [name, device] : devices)
    static_cast<DeviceParameters&>(world.registry.get<HapticDevice>(find_hand(name)->device)) = device;
  for (const auto prepare_system : {prepare_touch, prepare_tools, prepare_soft})
    if (Status s = prepare_system(world); !s) return s;
  for (std::string& sentence : make_orbits(world)) notes.push_back(std::move(sentence));

  for (std::size_t i = 0; i < objects.size(); ++i)
    if (const Deformable* surface = world.registry.find<Deformable>(object_entities[i]))
      surfaces[objects[i]] = *surface;
  for (const SessionHand& hand : hands) devices.emplace(hand.name, world.registry.get<HapticDevice>(hand.device));

  schedule.emplace(touch_schedule());
  soft = std::make_unique<SoftClock>(world);
  ticks = overruns = 0;
  time = 0.0;
  lived = false;
  edits = std::make_unique<Ring<Edit>>(kMostEdits);
  for (std::vector<HandRow>& slot : rows.slots()) slot.assign(hands.size(), {});
  view.reset(world);
  for (SessionHand& old : before) {
    SessionHand* const hand = find_hand(old.name);
    if (!hand || old.source == HandSource::kLevel || old.source == HandSource::kNone) continue;
    hand->driver = std::move(old.driver);
    hand->can = old.can;
    hand->path = std::move(old.path);
    hand->source = HandSource::kNone;
    if (Status s = give(*hand, old.source); !s) return s;
  }
  return Done{};
}

SessionHand* Session::Parts::find_hand(const std::string& name) {
  for (SessionHand& hand : hands)
    if (hand.name == name) return &hand;
  return nullptr;
}
const SessionHand* Session::Parts::find_hand(const std::string& name) const {
  return const_cast<Parts*>(this)->find_hand(name);
}

Error Session::Parts::unknown_hand(const std::string& name) const {
  std::string names;
  for (const SessionHand& hand : hands) names += (names.empty() ? "" : ", ") + hand.name;
  return {"`" + name + "`", names.empty() ? "the scene has no probe and no tool; add one with Scene::add_probe"
                                          : "is no probe or tool; they are: " + names};
}

Result<Entity> Session::Parts::find_object(const std::string& name) const {
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (objects[i] == name) return object_entities[i];
  std::string names;
  for (const std::string& object : objects) names += (names.empty() ? "" : ", ") + object;
  return Error{"`" + name + "`", names.empty() ? "the scene has no object; add one with Scene::add_surface"
                                               : "is no object; they are: " + names};
}

Status Session::Parts::stand_still(const char* what) const {
  if (!clock) return Done{};
  return Error{what, "the clocks are running; call Session::stop() first"};
}

Status Session::Parts::give(SessionHand& hand, HandSource source) {
  if (hand.source == source && source == HandSource::kPose) return Done{};
  if (hand.source != HandSource::kNone && hand.source != HandSource::kLevel)
    return Error{"`" + hand.name + "`", "has a source already; call Session::release() first"};
  HapticDevice& device = world.registry.get<HapticDevice>(hand.device);
  device.path = {};
  device.driver = DriverKind::kExternal;
  device.status = source == HandSource::kPath ? DeviceStatus::kReady : DeviceStatus::kLost;
  hand.placed = false;
  hand.source = source;
  if (source == HandSource::kPath) {
    device.driver = DriverKind::kScript;
    device.path = world.paths.add(Path(hand.path));
  }
  static_cast<DeviceParameters&>(device) = limits_of(hand);
  return Done{};
}

DeviceParameters Session::Parts::limits_of(const SessionHand& hand) const {
  DeviceParameters limits = devices.at(hand.name);
  const DeviceCapabilities& can = hand.can;
  if (can.max_force > 0.0) limits.max_force = std::min(limits.max_force, can.max_force);
  if (can.max_stiffness > 0.0)
    limits.max_stiffness =
        limits.max_stiffness > 0.0 ? std::min(limits.max_stiffness, can.max_stiffness) : can.max_stiffness;
  return limits;
}

void Session::Parts::zero_drivers() noexcept {
  for (SessionHand& hand : hands) {
    if (!hand.driver) continue;
    try {
      hand.driver->write({});
    } catch (...) {  // what fails is left: its device's own watchdog ends the force
    }
  }
}

void Session::Parts::close_driver(SessionHand& hand) noexcept {
  if (!hand.driver) return;
  try {
    hand.driver->write({});
  } catch (...) {  // closed all the same
  }
  try {
    hand.driver->close();
  } catch (...) {  // gone all the same
  }
  hand.driver.reset();
  hand.can = {};
}

void Session::Parts::read_told(SessionHand& hand, Tick tick) {
  HapticDevice& device = world.registry.get<HapticDevice>(hand.device);
  if (hand.told->acquire()) {
    const ToldPose& to = hand.told->read();
    const double since = tick.time - hand.heard_at;
    hand.lasts = clock && hand.placed ? std::clamp(since, tick.dt, kLongestWay) : tick.dt;
    hand.from = hand.placed ? hand.now : to;
    hand.heard_at = tick.time;
    hand.placed = true;
    device.status = DeviceStatus::kReady;
  }
  if (clock && tick.time - hand.heard_at > kToldHolds) hand.placed = false;  // it grows stale
  if (!hand.placed) return;
  const ToldPose& to = hand.told->read();
  const double share = std::min(1.0, (tick.time - hand.heard_at + tick.dt) / hand.lasts);
  hand.now.position = share < 1.0 ? glm::mix(hand.from.position, to.position, share) : to.position;
  hand.now.rotation = share < 1.0 ? glm::slerp(hand.from.rotation, to.rotation, share) : to.rotation;
  device.position = hand.now.position;
  device.rotation = hand.now.rotation;
  device.sensed_at = tick.time;
}

void Session::Parts::read_driver(SessionHand& hand, Tick tick) {
  DeviceSample sample;
  if (!hand.driver->read(sample)) return;
  HapticDevice& device = world.registry.get<HapticDevice>(hand.device);
  device.position = sample.position;
  device.rotation = sample.rotation;
  device.sensed_at = tick.time;
  device.status = sample.ready ? DeviceStatus::kReady : DeviceStatus::kLost;
}

void Session::Parts::before(Tick tick) {
  Edit edit;
  while (edits->pop(edit)) apply_edit(world, edit);
  for (SessionHand& hand : hands) {
    if (hand.source == HandSource::kPose) read_told(hand, tick);
    if (hand.source == HandSource::kDriver) read_driver(hand, tick);
  }
}

void Session::Parts::idle() {
  DeviceSample unheard;
  for (SessionHand& hand : hands) {
    if (!hand.driver) continue;
    static_cast<void>(hand.driver->read(unheard));
    hand.driver->write({});
  }
}

}  // namespace pliant
