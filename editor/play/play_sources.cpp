// Sources of probes and tools in a run, and the repetition of a past.
#include <fmt/format.h>

#include <algorithm>

#include "content/level/device_request.h"
#include "content/level/script.h"
#include "devices/choose.h"
#include "devices/wrappers/chain.h"
#include "editor/play/play_inside.h"
#include "systems/device/repeat.h"

namespace pliant {

PlayRun::Inside::Level PlayRun::Inside::remember(const SessionEffector& effector) const {
  const HapticDevice& device = inner->world.registry.get<HapticDevice>(effector.device);
  return {device.driver, device.path, effector.source, device.id};
}

void PlayRun::Inside::bring_back(SessionEffector& effector, const Level& level) {
  HapticDevice& device = inner->world.registry.get<HapticDevice>(effector.device);
  device.driver = level.driver;
  device.path = level.path;
  device.status = level.path.valid() ? DeviceStatus::kReady : DeviceStatus::kLost;
  device.id = level.id;
  effector.source = level.source;
  effector.placed = false;
}

// The kind of a source and the name of its device: of the level's, what that is, and none that the level may not open.
std::pair<PlaySource::Kind, std::string> PlayRun::Inside::wanted(const std::string& name, const PlaySource& source,
                                                                 const Level& level) {
  PlaySource::Kind kind = source.kind;
  std::string id = source.what;
  if (kind == PlaySource::Kind::kLevel && level.driver == DriverKind::kMouse) kind = PlaySource::Kind::kMouse;
  if (kind == PlaySource::Kind::kLevel && level.driver == DriverKind::kExternal && !level.id.empty()) {
    kind = PlaySource::Kind::kDriver;
    id = level.id;
    if (!run.options_.allowed.contains(id)) {
      DeviceRequest request = device_request(id);
      for (const std::string& sentence : request.refused)
        say(
            fmt::format("`{}`: the level asks for more than it may: {}; pick the device in the tab Devices, or press "
                        "Play and allow it",
                        name, sentence));
      id = std::move(request.allowed);
      if (id.empty()) kind = PlaySource::Kind::kNone;
    }
  }
  return {kind, std::move(id)};
}

Status PlayRun::Inside::follow(const std::string& name, const PlaySource& source) {
  Result<Path> path = source.path ? Result<Path>(*source.path) : load_script(source.what);
  if (!path) return path.error();
  Path followed = run.options_.repeats && !path->rows.empty() && !path->repeats
                      ? repeated(*path, std::max(period, period_of(*path)))
                      : std::move(path).value();
  if (source.from > 0.0)
    for (PathRow& row : followed.rows) row.time += source.from;
  return session->follow(name, std::move(followed));
}

// The mouse moves it from where it is. `rotation`: its device's.
Status PlayRun::Inside::take(SessionEffector& effector, dquat rotation) {
  const HapticDevice& device = inner->world.registry.get<HapticDevice>(effector.device);
  if (!moved.empty()) {  // there is only one mouse
    const std::string before = moved;
    apply(before, {PlaySource::Kind::kNone, {}});
    say(fmt::format("the mouse moves `{}` now; nothing moves `{}`", effector.name, before));
  }
  dvec3 at = device.position;
  if (const Probe* probe = inner->world.registry.find<Probe>(effector.entity)) {
    run.hand.take_probe(inner->world, *probe, run.options_.view,
                        inner->ticks > 0 ? std::optional(device.position) : std::nullopt);
    at = run.hand.update(0.0).value_or(at);
  } else {
    if (inner->ticks == 0)
      if (const Pose* pose = inner->world.registry.find<Pose>(effector.entity)) at = pose->position;
    run.hand.take_tool(inner->world, effector.entity, at);
  }
  held = rotation;
  if (const Pose* pose = inner->world.registry.find<Pose>(effector.entity); pose && inner->ticks == 0)
    held = pose->rotation;
  Status done = session->move(effector.name, at, held);
  if (done) moved = effector.name;
  return done;
}

// If the source is not available, the probe has none.
void PlayRun::Inside::apply(const std::string& name, const PlaySource& source) {
  SessionEffector* const effector = inner->find_effector(name);
  if (!effector) return;
  const auto index = static_cast<std::size_t>(effector - inner->effectors.data());
  auto [kind, id] = wanted(name, source, of_level[index]);
  if (moved == name) {
    moved.clear();
    run.hand.let_go();
    effector->hold = {};
    if (Probe* const probe = inner->world.registry.find<Probe>(effector->entity)) probe->hold = {};
  }
  sources[index] = source;
  HapticDevice& device = inner->world.registry.get<HapticDevice>(effector->device);
  const dquat rotation = device.rotation;
  if (effector->source != EffectorSource::kNone && effector->source != EffectorSource::kLevel)
    static_cast<void>(session->release(name));
  connected.erase(name);
  if (kind == PlaySource::Kind::kDriver && (run.options_.past || inner->ticks > 0)) {
    say(fmt::format("the device of `{}` takes over at the next Play", name));  // it needs real time
    static_cast<void>(session->release(name));
    return;
  }
  if (kind == PlaySource::Kind::kDriver) {
    bool by_mouse = false;
    if (const Status done = connect(*effector, id, by_mouse); !done) {
      say(fmt::format("`{}`: {}", name, done.error().message()));
      sources[index] = {PlaySource::Kind::kNone, {}};
      static_cast<void>(session->release(name));
      return;
    }
    if (!by_mouse) return;
    kind = PlaySource::Kind::kMouse;
  }
  Status done = Done{};
  switch (kind) {
    case PlaySource::Kind::kLevel:
      if (effector->source != of_level[index].source) bring_back(*effector, of_level[index]);
      return;
    case PlaySource::Kind::kNone:
      done = session->release(name);
      break;
    case PlaySource::Kind::kOrbit:
      done = session->orbit(name);
      break;
    case PlaySource::Kind::kDriver:  // above
      break;
    case PlaySource::Kind::kScript:
      done = follow(name, source);
      break;
    case PlaySource::Kind::kMouse:
      done = take(*effector, rotation);
      break;
  }
  if (done) return;
  say(done.error().message());
  sources[index] = {PlaySource::Kind::kNone, {}};
  if (kind != PlaySource::Kind::kNone) static_cast<void>(session->release(name));
}

Status PlayRun::Inside::connect(const SessionEffector& effector, const std::string& id, bool& by_mouse) {
  if (there.empty()) there = list_devices();
  auto chosen = choose_device(id, there);
  if (!chosen) return chosen.error();
  for (const std::string& note : chosen->notes) say(fmt::format("`{}`: {}", effector.name, note));
  by_mouse = chosen->id.empty();
  if (by_mouse) return Done{};
  auto made = make_device(chosen->id);
  if (!made) return made.error();
  for (const std::string& note : made->notes) say(fmt::format("`{}`: {}", effector.name, note));
  if (Status s = inner->connect(effector.name, std::move(made->driver), made->id, chosen->id); !s) return s;
  if (!effector.link.note().empty()) say(fmt::format("`{}`: {}", effector.name, effector.link.note()));
  connected[effector.name] = {chosen->id, chosen->name};
  return Done{};
}

bool PlayRun::Inside::feels() const {
  return std::any_of(inner->effectors.begin(), inner->effectors.end(),
                     [](const SessionEffector& each) { return each.link.connected(); });
}

void PlayRun::Inside::view(DevicesView& out) const {
  for (SessionEffector& each : inner->effectors) {
    const auto of = connected.find(each.name);
    if (each.link && of != connected.end())
      out.devices.push_back({each.name, of->second.first, of->second.second, each.link.can(), each.link.report()});
  }
  for (const DeviceInfo& device : there)
    if (!device.missing.empty()) out.unusable.push_back(device);
}

void PlayRun::Inside::apply_all() {
  std::vector<std::pair<std::string, PlaySource>> wanted;
  for (const SessionEffector& effector : inner->effectors) {
    PlaySource source;
    for (const auto& [name, its] : run.options_.sources)
      if (name == effector.name) source = its;
    wanted.emplace_back(effector.name, source);
  }
  // There is only one mouse. The user's choice comes first, then the level's first.
  std::stable_partition(wanted.begin(), wanted.end(),
                        [](const auto& each) { return each.second.kind == PlaySource::Kind::kMouse; });
  for (auto& [name, source] : wanted) {
    const auto index = static_cast<std::size_t>(inner->find_effector(name) - inner->effectors.data());
    const bool another = source.kind == PlaySource::Kind::kLevel && of_level[index].driver == DriverKind::kMouse;
    if (another && !moved.empty()) {
      say(fmt::format("the mouse moves `{}`; nothing moves `{}`: choose the mouse for it under What moves the probes",
                      moved, name));
      source.kind = PlaySource::Kind::kNone;
    }
    apply(name, source);
  }
  watch();
}

// If the mouse moves nothing, it drags the first tool that it is pressed on.
void PlayRun::Inside::watch() {
  watched.clear();
  if (!moved.empty() || realtime) return;
  for (const SessionEffector& effector : inner->effectors)
    if (!inner->world.registry.has<Probe>(effector.entity)) {
      watched = effector.name;
      run.hand.watch_tool(effector.entity);
      return;
    }
}

void PlayRun::Inside::begin_past(const PlayPast& of, std::uint64_t to) {
  before_past.clear();
  for (const SessionEffector& effector : inner->effectors) before_past.push_back(remember(effector));
  run.hand.let_go();
  until = std::min<std::uint64_t>(to, of.ticks.size());
  next_hold = 0;
  again = true;
  inner->begin_replay(of);
}

// The present starts at the time that was reached.
void PlayRun::Inside::end_past() {
  again = false;
  inner->replay.reset();
  inner->replayed.reset();
  const std::vector<PlaySource> wanted = sources;
  moved.clear();
  for (std::size_t i = 0; i < inner->effectors.size(); ++i) {
    SessionEffector& effector = inner->effectors[i];
    if (before_past[i].source == EffectorSource::kPose || before_past[i].source == EffectorSource::kDriver) {
      effector.source = EffectorSource::kNone;
      apply(effector.name, wanted[i]);
    } else {
      bring_back(effector, before_past[i]);
    }
  }
  watch();
  run.options_.past.reset();
}

}  // namespace pliant
