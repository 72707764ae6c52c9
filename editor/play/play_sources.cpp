// What moves the probes and tools of a run, and how a past is had again.
#include <fmt/format.h>

#include <algorithm>

#include "content/level/script.h"
#include "editor/play/play_inside.h"

namespace pliant {

PlayRun::Inside::Level PlayRun::Inside::remember(const SessionEffector& effector) const {
  const HapticDevice& device = parts->world.registry.get<HapticDevice>(effector.device);
  return {device.driver, device.path, effector.source};
}

void PlayRun::Inside::bring_back(SessionEffector& effector, const Level& level) {
  HapticDevice& device = parts->world.registry.get<HapticDevice>(effector.device);
  device.driver = level.driver;
  device.path = level.path;
  device.status = level.path.valid() ? DeviceStatus::kReady : DeviceStatus::kLost;
  effector.source = level.source;
  effector.placed = false;
}

// One that cannot be had leaves the probe without any: nobody moves it.
void PlayRun::Inside::apply(const std::string& name, const PlaySource& source) {
  SessionEffector* const effector = parts->find_effector(name);
  if (!effector) return;
  const auto index = static_cast<std::size_t>(effector - parts->effectors.data());
  PlaySource::Kind kind = source.kind;
  if (kind == PlaySource::Kind::kLevel && of_level[index].driver == DriverKind::kMouse) kind = PlaySource::Kind::kMouse;
  if (moved == name) {
    moved.clear();
    run.hand.let_go();
  }
  sources[index] = source;
  HapticDevice& device = parts->world.registry.get<HapticDevice>(effector->device);
  const dquat rotation = device.rotation;
  if (effector->source != EffectorSource::kNone && effector->source != EffectorSource::kLevel)
    static_cast<void>(session->release(name));
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
    case PlaySource::Kind::kDriver:
      done = session->connect(name, source.what);
      break;
    case PlaySource::Kind::kScript: {
      Result<Path> path = source.path ? Result<Path>(*source.path) : load_script(source.what);
      if (!path) {
        done = path.error();
        break;
      }
      if (source.from > 0.0)
        for (PathRow& row : path->rows) row.time += source.from;
      done = session->follow(name, std::move(path).value());
      break;
    }
    case PlaySource::Kind::kMouse: {
      if (!moved.empty()) {  // there is one mouse
        const std::string before = moved;
        apply(before, {PlaySource::Kind::kNone, {}});
        say(fmt::format("the mouse moves `{}` now; nothing moves `{}`", name, before));
      }
      dvec3 at = device.position;
      if (const Probe* probe = parts->world.registry.find<Probe>(effector->entity)) {
        run.hand.take_probe(parts->world, probe->radius, run.options_.view,
                            parts->ticks > 0 ? std::optional(device.position) : std::nullopt);
        at = run.hand.update(0.0).value_or(at);
      } else {
        if (parts->ticks == 0)
          if (const Pose* pose = parts->world.registry.find<Pose>(effector->entity)) at = pose->position;
        run.hand.take_tool(parts->world, effector->entity, at);
      }
      held = rotation;
      if (const Pose* pose = parts->world.registry.find<Pose>(effector->entity); pose && parts->ticks == 0)
        held = pose->rotation;
      done = session->move(name, at, held);
      if (done) moved = name;
      break;
    }
  }
  if (done) return;
  say(done.error().message());
  sources[index] = {PlaySource::Kind::kNone, {}};
  if (kind != PlaySource::Kind::kNone) static_cast<void>(session->release(name));
}

void PlayRun::Inside::apply_all() {
  std::vector<std::pair<std::string, PlaySource>> wanted;
  for (const SessionEffector& effector : parts->effectors) {
    PlaySource source;
    for (const auto& [name, its] : run.options_.sources)
      if (name == effector.name) source = its;
    wanted.emplace_back(effector.name, source);
  }
  for (const auto& [name, source] : wanted) apply(name, source);
}

void PlayRun::Inside::begin_past(const PlayPast& of, std::uint64_t to) {
  before_past.clear();
  for (const SessionEffector& effector : parts->effectors) before_past.push_back(remember(effector));
  run.hand.let_go();
  Recording recording;
  recording.header.rate = parts->world.simulation.touch_rate;
  recording.ticks = of.ticks;
  recording.poses = of.poses;
  until = std::min<std::uint64_t>(to, of.ticks.size());
  next_edit = 0;
  again = true;
  parts->begin_replay(std::move(recording));
}

// The moment that was reached becomes the present.
void PlayRun::Inside::end_past() {
  again = false;
  parts->replayed.reset();
  const std::vector<PlaySource> wanted = sources;
  moved.clear();
  for (std::size_t i = 0; i < parts->effectors.size(); ++i) {
    SessionEffector& effector = parts->effectors[i];
    if (before_past[i].source == EffectorSource::kPose || before_past[i].source == EffectorSource::kDriver) {
      effector.source = EffectorSource::kNone;
      apply(effector.name, wanted[i]);
    } else {
      bring_back(effector, before_past[i]);
    }
  }
  run.options_.past.reset();
}

}  // namespace pliant
