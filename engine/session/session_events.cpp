// Actions of a program on a session between ticks, other than moving its probes and setting parameters: external forces
// and impulses. An event is checked here, then sent to the clock that applies it and to the recording.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/soft_body.h"
#include "engine/run/driver_limits.h"
#include "engine/session/session_run.h"
#include "systems/device/devices.h"
#include "systems/safety/safety.h"
#include "systems/soft/soft_state.h"

namespace pliant {
namespace {

constexpr std::size_t kMostStanding = 512;  // a new world receives them all before its first tick
constexpr double kMostValue = 1e9;          // [N], [m]...: a larger value is a mistake of units

bool sound(const RecordedEvent& event) {
  return std::all_of(event.values.begin(), event.values.end(), [](double v) { return std::abs(v) <= kMostValue; });
}

std::array<double, 7> two(dvec3 a, dvec3 b) {
  return {a.x, a.y, a.z, b.x, b.y, b.z, 0.0};
}

BodyEditKind kind_of(const RecordedEvent& event) {
  switch (event.kind) {
    case EventKind::kPointForce:
      return BodyEditKind::kLoadAt;
    case EventKind::kPush:
      return BodyEditKind::kPush;
    case EventKind::kPointPush:
      return BodyEditKind::kPushAt;
    default:
      return BodyEditKind::kLoad;
  }
}

// Finds a triangle of the collision mesh with this source vertex as a corner.
bool find_corner(const Mesh& mesh, std::uint32_t vertex, BodyEdit& edit) {
  if (vertex >= mesh.of_source.size() || mesh.of_source[vertex] == kBorder) return false;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (mesh.triangles[t][k] == mesh.of_source[vertex]) {
        edit.triangle = t, edit.corner = k;
        return true;
      }
  return false;
}

bool at_a_vertex(EventKind kind) {
  return kind == EventKind::kPointForce || kind == EventKind::kPointPush;
}

// True for the same standing force: the new value replaces the old.
bool replaces(const RecordedEvent& now, const RecordedEvent& before) {
  return now.kind == before.kind && now.name == before.name && now.vertex == before.vertex;
}

}  // namespace

std::uint32_t SessionRun::note_event(const RecordedEvent& event) {
  if (!history.lacking) {
    history.events.push_back(event);
    history.events.back().tick = ticks;
  }
  return recorder ? recorder->announce(event) : 0;
}

void SessionRun::note_new_source(Entity effector, const RecordedEvent& event) {
  const std::uint32_t number = note_event(event);
  if (number > 0) edits->push({effector, EventEdit{EventKind::kNewSource, 0.0, {}, {}, {}}, number});
}

void SessionRun::keep_standing(const RecordedEvent& event) {
  if (event.kind == EventKind::kPush || event.kind == EventKind::kPointPush || event.kind == EventKind::kPlace) return;
  std::erase_if(standing, [&](const RecordedEvent& before) { return replaces(event, before); });
  if (event.kind == EventKind::kPresent) {
    if (event.values[0] == 0.0) standing.push_back(event);
  } else if (event.first() != dvec3(0) || event.second() != dvec3(0))
    standing.push_back(event);
}

Status SessionRun::send_standing() {
  for (const RecordedEvent& event : std::vector<RecordedEvent>(standing))
    if (Status s = send(event, "Session::restart"); !s) return s;
  return Done{};
}

Status SessionRun::send(RecordedEvent event, const char* what) {
  const std::string where = std::string(what) + " `" + event.name + "`";
  if (!sound(event)) return Error{where, "a value is no number, or beyond 1e9", "use SI units"};
  if (!edits->has_room()) return Error{where, "too many changes wait for a tick", "make fewer at a time"};
  const bool once =
      event.kind == EventKind::kPush || event.kind == EventKind::kPointPush || event.kind == EventKind::kPlace;
  if (!once && standing.size() >= kMostStanding &&
      std::none_of(standing.begin(), standing.end(), [&](const RecordedEvent& it) { return replaces(event, it); }))
    return Error{where, "512 forces and objects taken out hold already", "end one first"};
  if (event.kind == EventKind::kPlace || event.kind == EventKind::kPresent) return send_to_object(event, what);
  return event.kind == EventKind::kHandForce ? send_to_hand(event, what) : send_to_body(event, what);
}

Status SessionRun::send_to_hand(const RecordedEvent& event, const char* what) {
  const SessionEffector* const effector = find_effector(event.name);
  if (!effector) return unknown_effector(event.name);
  if (event.second() != dvec3(0) && world.registry.has<Probe>(effector->entity))
    return Error{std::string(what) + " `" + event.name + "`", "is a probe, which has no torque", "give a force alone"};
  edits->push({effector->entity, EventEdit{event.kind, 0.0, event.first(), event.second(), {}}, note_event(event)});
  keep_standing(event);
  return Done{};
}

Status SessionRun::send_to_body(const RecordedEvent& event, const char* what) {
  const auto entity = find_object(event.name);
  if (!entity) return entity.error();
  const std::string where = std::string(what) + " `" + event.name + "`";
  const RigidBody* const rigid = world.registry.find<RigidBody>(*entity);
  if (world.registry.has<Deformable>(*entity))
    return Error{where, "is a deformable surface, which gives way to contacts alone", "make it a soft body"};
  if (rigid && rigid->fixed) return Error{where, "is fixed", "nothing moves it"};
  if (world.registry.has<Handle6>(*entity))
    return Error{where, "is held by a hand", "call Session::set_hand_force() instead"};
  BodyEdit body{kind_of(event), *entity, 0, 0, event.first(), event.second(), {}};
  const Mesh& mesh = *collision_mesh_of(world, *entity);
  if (at_a_vertex(event.kind) && !find_corner(mesh, event.vertex, body))
    return Error{
        where, fmt::format("vertex {} is none of its {}, or no triangle uses it", event.vertex, mesh.of_source.size()),
        "see Session::vertices()"};
  if (!world.soft->body_edits.push(body))
    return Error{where, "too many changes wait for a soft step", "make fewer at a time"};
  edits->push({*entity, EventEdit{event.kind, 0.0, {}, {}, {}}, note_event(event)});
  keep_standing(event);
  return Done{};
}

Status SessionRun::check_place(Entity object, const RecordedEvent& event) const {
  const std::string where = "`" + event.name + "`";
  const Registry& all = world.registry;
  if (all.has<Handle6>(object)) return Error{where, "is held by a hand, which says where it is"};
  if (event.kind != EventKind::kPlace) return Done{};
  if (!plausible_position(event.first()) ||
      !plausible_rotation({event.values[3], event.values[4], event.values[5], event.values[6]}))
    return Error{where, "the place is not finite, or its rotation not of unit length", "normalise it"};
  if (!all.has<Deformable>(object)) return Done{};
  if (all.has<MovingPose>(object)) return Error{where, "is carried by a motion of the scene, which says where it is"};
  if (world.soft && !world.soft->yielding.empty())
    return Error{where, "is a surface that soft or rigid bodies may press, which stays where it is",
                 "take it out instead"};
  return Done{};
}

Status SessionRun::send_to_object(const RecordedEvent& event, const char* what) {
  const auto entity = find_object(event.name);
  if (!entity) return entity.error();
  if (Status s = check_place(*entity, event); !s) return s.error().at(std::string(what) + " " + s.error().where);
  const bool elsewhere = event.kind == EventKind::kPlace, present = event.values[0] != 0.0;
  EventEdit edit;
  edit.kind = event.kind;
  edit.value = event.values[0];
  edit.force = event.first();
  if (elsewhere)
    edit.rotation = glm::normalize(dquat(event.values[3], event.values[4], event.values[5], event.values[6]));
  BodyEdit body;
  body.kind = elsewhere ? BodyEditKind::kPlace : present ? BodyEditKind::kPresent : BodyEditKind::kAbsent;
  body.body = *entity;
  body.pose = {edit.force, edit.rotation};
  if (world.soft && !world.soft->body_edits.push(body))
    return Error{std::string(what) + " `" + event.name + "`", "too many changes wait for a soft step",
                 "make fewer at a time"};
  edits->push({*entity, edit, note_event(event)});
  keep_standing(event);
  if (!elsewhere)
    taken_out[static_cast<std::size_t>(std::find(objects.begin(), objects.end(), event.name) - objects.begin())] =
        !present;
  return Done{};
}

Status SessionRun::perform(const RecordedEvent& event) {
  if (event.kind == EventKind::kSet) return apply_setting(event.name + "." + event.key, Setting::kSend);
  if (event.kind != EventKind::kNewSource) return send(event, "replay");
  const SessionEffector* const effector = find_effector(event.name);
  if (!effector) return unknown_effector(event.name);
  HapticDevice& device = world.registry.get<HapticDevice>(effector->device);
  device.can = kNoDriver;
  device.workspace = 1.0;
  std::vector<std::string> limits;
  for (std::size_t at = 0, end; (end = event.key.find('\n', at)) != std::string::npos; at = end + 1)
    limits.push_back(event.key.substr(at, end - at));
  begin_anew(world, effector->entity);
  note_new_source(effector->entity, event);
  return apply_driver_settings(world, limits);
}

void SessionRun::replay_events(std::uint64_t tick) {
  const std::vector<RecordedEvent>& events = replayed->events;
  for (; replayed_events < events.size() && events[replayed_events].tick <= tick; ++replayed_events) {
    const RecordedEvent& event = events[replayed_events];
    if (const Status done = perform(event); !done)
      notes.push_back(fmt::format("tick {} of the recording: {}", event.tick, done.error().message()));
  }
}

Status Session::set_hand_force(const std::string& effector, dvec3 force, dvec3 torque) {
  return run_->send({0, EventKind::kHandForce, effector, {}, 0, two(force, torque)}, "Session::set_hand_force");
}

Status Session::set_body_force(const std::string& body, dvec3 force, dvec3 torque) {
  return run_->send({0, EventKind::kBodyForce, body, {}, 0, two(force, torque)}, "Session::set_body_force");
}

Status Session::set_point_force(const std::string& body, std::uint32_t vertex, dvec3 force) {
  return run_->send({0, EventKind::kPointForce, body, {}, vertex, two(force, dvec3(0))}, "Session::set_point_force");
}

Status Session::place(const std::string& object, dvec3 position, dquat rotation) {
  return run_->send({0,
                     EventKind::kPlace,
                     object,
                     {},
                     0,
                     {position.x, position.y, position.z, rotation.w, rotation.x, rotation.y, rotation.z}},
                    "Session::place");
}

Status Session::take_out(const std::string& object) {
  return run_->send({0, EventKind::kPresent, object, {}, 0, {0.0}}, "Session::take_out");
}

Status Session::put_back(const std::string& object) {
  return run_->send({0, EventKind::kPresent, object, {}, 0, {1.0}}, "Session::put_back");
}

Result<bool> Session::is_out(const std::string& object) const {
  const auto found = std::find(run_->objects.begin(), run_->objects.end(), object);
  if (found == run_->objects.end()) return run_->find_object(object).error();
  return run_->taken_out[static_cast<std::size_t>(found - run_->objects.begin())] != 0;
}

Status Session::push(const std::string& body, dvec3 impulse, dvec3 angular_impulse) {
  return run_->send({0, EventKind::kPush, body, {}, 0, two(impulse, angular_impulse)}, "Session::push");
}

Status Session::push_at(const std::string& body, std::uint32_t vertex, dvec3 impulse) {
  return run_->send({0, EventKind::kPointPush, body, {}, vertex, two(impulse, dvec3(0))}, "Session::push_at");
}

}  // namespace pliant
