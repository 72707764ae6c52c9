// Session::set and get: parameters between ticks. Requests are checked here, on the owner's thread, against the key
// table of the level format. The clocks receive all parameters of a kind together (apply_edit.cpp,
// systems/soft/soft_step.cpp).
#include <fmt/format.h>

#include "components/varying.h"
#include "content/level/varying_keys.h"
#include "engine/session/live_set.h"
#include "engine/session/session_run.h"

namespace pliant {
namespace {

Result<LiveNamed> find_named(const SessionRun& p, const std::string& name) {
  LiveNamed named;
  named.name = name;
  if (const auto body = p.bodies.find(name); body != p.bodies.end()) named.node = body->second;
  if (const auto surface = p.surfaces.find(name); surface != p.surfaces.end()) named.node.deformable = surface->second;
  if (const auto device = p.devices.find(name); device != p.devices.end()) {
    named.node.device.emplace();
    static_cast<DeviceParameters&>(*named.node.device) = device->second;
  }
  if (!extensions_of(named).empty()) {
    if (const auto object = p.find_object(name)) named.object = *object;
    if (const SessionEffector* const hand = p.find_effector(name))
      named.hand = hand->entity, named.device = hand->device;
    if (const auto effect = p.effects.find(name); effect != p.effects.end()) named.effect = effect->second;
    named.several_effects = p.effects.contains(name) && named.effect == kNoEntity;
    return named;
  }
  std::vector<std::string> names = p.objects;
  for (const SessionEffector& effector : p.effectors) names.push_back(effector.name);
  for (const auto& [effect, entity] : p.effects) names.push_back(effect);
  return error_at("`" + name + "`",
                  unknown("name", name, "the scene", "its objects, probes, tools and effects", names));
}

void keep(SessionRun& p, const std::string& name, const Extension& extension, const LevelNode& node) {
  if (extension.name == "deformable")
    p.surfaces[name] = *node.deformable;
  else if (extension.name == "haptic_device")
    p.devices[name] = *node.device;
  else
    extension.name == "soft_body"    ? void(p.bodies[name].soft_body = node.soft_body)
    : extension.name == "rigid_body" ? void(p.bodies[name].rigid_body = node.rigid_body)
    : extension.name == "probe"      ? void(p.bodies[name].probe = node.probe)
    : extension.name == "effect"     ? void(p.bodies[name].effect = node.effect)
                                     : void(p.bodies[name].handle = node.handle);
}

// For recordings: the key, or the keys that an alias has changed.
void note_settings(SessionRun& p, const std::string& name, const Extension& extension, const Key& key,
                   const LevelNode& before, const LevelNode& now) {
  for (const Key& each : extension.keys) {
    if (each.alias || (key.alias ? each.get(&before) == each.get(&now) : each.name != key.name)) continue;
    const Json value = each.get(&now);
    p.settings[name + "." + extension.name + "." + each.name] = value.is_string() ? value.get<std::string>()
                                                                : value.is_number()
                                                                    ? fmt::format("{}", value.get<double>())
                                                                    : value.dump();
  }
  if (!now.deformable) return;
  const std::string follows = name + ".deformable.stiffness";  // derived from `young` or a table, if set
  if (now.deformable->young > 0.0 || stiffness_of_table(now))
    p.settings.erase(follows);
  else if ((before.deformable->young > 0.0 && key.name == "young") || stiffness_of_table(before))
    p.settings[follows] = fmt::format("{}", now.deformable->stiffness);
}

// `note`: records the change, once there is room for it.
template <class Note>
Status send(SessionRun& p, SessionChange& change, const Note& note) {
  const bool soft = p.world.soft && !change.soft.empty();
  if (!p.edits->has_room() || (soft && !p.world.soft->parameter_edits.has_room()))
    return Error{"Session::set", "too many values wait for a tick", "set fewer at a time"};
  if (change.touch.empty()) change.touch.push_back({change.entity, EventEdit{}, 0});
  change.touch.front().number = note();
  for (const Edit& edit : change.touch) p.edits->push(edit);
  if (soft)
    for (const ParameterEdit& edit : change.soft) p.world.soft->parameter_edits.push(edit);
  return Done{};
}

// `sent` is false if a new world follows, which begins with the value.
Status set_value(SessionRun& p, const std::string& name, const std::string& key_name, Json value, bool sent = true) {
  const Result<LiveNamed> named = find_named(p, name);
  if (!named) return named.error();
  Result<LiveSet> set = live_set(p.world, *named, key_name, std::move(value));
  if (!set) return set.error();
  if (sent)
    if (Status s = send(p, set->change,
                        [&] {
                          return p.note_event({0, EventKind::kSet, name, set->words(), 0, {}});
                        });
        !s)
      return s;
  keep(p, name, *set->extension, set->now);
  note_settings(p, name, *set->extension, *set->key, named->node, set->now);
  return Done{};
}

// Of a varied key, its value at `time` [s].
Result<Json> value_of(const SessionRun& p, double time, const std::string& object, const std::string& key) {
  const Result<LiveNamed> named = find_named(p, object);
  if (!named) return named.error();
  const Result<FoundKey> found = find_named_key(*named, key, false);
  if (!found) return found.error();
  LevelNode now = named->node;
  const auto entity = p.find_object(object);
  const Varying* const varying = entity ? p.world.registry.find<Varying>(*entity) : nullptr;
  if (varying && now.deformable) vary(*varying, time, *now.deformable);
  return found->key->get(&now);
}

}  // namespace

Status SessionRun::apply_setting(const std::string& setting, Setting how) {
  const bool sent = how == Setting::kSend;
  const std::size_t equals = setting.rfind('=');
  const std::string path = setting.substr(0, equals),
                    text = equals == std::string::npos ? "" : setting.substr(equals + 1);
  for (const Extension& extension : extension_table())
    for (const Key& key : extension.keys) {
      const std::string end = "." + extension.name + "." + key.name;
      if (extension.on_scene || path.size() <= end.size() || !path.ends_with(end)) continue;
      const std::string object = path.substr(0, path.size() - end.size());
      const Json value = Json::parse(text, nullptr, false);
      if (value.is_number() && !std::isfinite(value.get<double>())) break;
      if (value.is_number()) return set_value(*this, object, key.name, value, sent);
      const bool several = key.type == KeyType::kPair || key.type == KeyType::kVector;
      if (several && check_value(key, value)) break;
      return set_value(*this, object, key.name, several ? value : Json(text), sent);
    }
  return Error{"`" + setting + "`", "cannot change in a session", "set it in the scene"};
}

std::vector<Error> SessionRun::apply_settings(std::vector<std::string> waiting, Setting how) {
  std::vector<Error> refused;
  for (std::size_t before = waiting.size() + 1; waiting.size() < before;) {
    before = waiting.size();
    refused.clear();
    std::vector<std::string> again;
    for (const std::string& setting : waiting)
      if (Status applied = apply_setting(setting, how); !applied) {
        refused.push_back(applied.error());
        again.push_back(setting);
      }
    waiting = std::move(again);
  }
  return refused;
}

void SessionRun::keep_bodies() {
  bodies.clear();
  const auto node_of = [&](Entity entity, const std::string& name) {
    LevelNode& node = bodies[name];
    if (const auto* it = world.registry.find<SoftBody>(entity)) node.soft_body = *it;
    if (const auto* it = world.registry.find<RigidBody>(entity)) node.rigid_body = *it;
    if (const auto* it = world.registry.find<Handle6>(entity)) node.handle = *it;
    if (const auto* it = world.registry.find<Probe>(entity)) node.probe = *it;
  };
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (!world.registry.has<Deformable>(object_entities[i])) node_of(object_entities[i], objects[i]);
  for (const SessionEffector& effector : effectors) node_of(effector.entity, effector.name);
  for (const auto& [name, entity] : effects)
    if (entity != kNoEntity) bodies[name].effect = world.registry.get<Effect>(entity);
}

void SessionRun::restore_bodies() {
  const auto restore = [&](Entity entity, const LevelNode& node) {
    Registry& all = world.registry;
    if (node.soft_body && all.has<SoftBody>(entity))
      static_cast<SoftBodyParameters&>(all.get<SoftBody>(entity)) = *node.soft_body;
    if (node.rigid_body && all.has<RigidBody>(entity))
      static_cast<RigidBodyParameters&>(all.get<RigidBody>(entity)) = *node.rigid_body;
    if (node.handle && all.has<Handle6>(entity))
      static_cast<HandleParameters&>(all.get<Handle6>(entity)) = *node.handle;
    if (node.probe && all.has<Probe>(entity)) static_cast<ProbeParameters&>(all.get<Probe>(entity)) = *node.probe;
  };
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (const auto found = bodies.find(objects[i]); found != bodies.end()) restore(object_entities[i], found->second);
  for (const SessionEffector& effector : effectors)
    if (const auto found = bodies.find(effector.name); found != bodies.end()) restore(effector.entity, found->second);
  for (const auto& [name, entity] : effects)
    if (const auto found = bodies.find(name); entity != kNoEntity && found != bodies.end() && found->second.effect)
      static_cast<EffectParameters&>(world.registry.get<Effect>(entity)) = *found->second.effect;
}

Status Session::set(const std::string& object, const std::string& key, double value) {
  if (!std::isfinite(value)) return Error{"`" + object + "`: " + key, "is not a number"};
  return set_value(*run_, object, key, value);
}

Status Session::set(const std::string& object, const std::string& key, const std::string& word) {
  return set_value(*run_, object, key, word);
}

Status Session::set(const std::string& object, const std::string& key, const std::vector<double>& values) {
  for (const double value : values)
    if (!std::isfinite(value)) return Error{"`" + object + "`: " + key, "has a value that is not a number"};
  return set_value(*run_, object, key, values);
}

Result<double> Session::get(const std::string& object, const std::string& key) const {
  const Result<Json> value = value_of(*run_, time(), object, key);
  if (!value) return value.error();
  if (!value->is_number())
    return Error{"`" + object + "`: " + key, "is no single number", "read it by Session::json()", "call.refused"};
  return value->get<double>();
}

Result<std::string> Session::json(const std::string& object, const std::string& key) const {
  const Result<Json> value = value_of(*run_, time(), object, key);
  if (!value) return value.error();
  return value->dump(-1, ' ', false, Json::error_handler_t::replace);
}

const std::vector<Slider>& Session::sliders() const& {
  return run_->sliders;
}

std::vector<Slider> Session::sliders() && {
  return run_->sliders;
}

Result<NamedKeys> Session::keys(const std::string& name) const {
  const Result<LiveNamed> named = find_named(*run_, name);
  if (!named) return named.error();
  return NamedKeys{kind_of(*named), live_keys_of(*named)};
}

}  // namespace pliant
