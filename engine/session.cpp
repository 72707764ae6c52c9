// Session's own functions (pliant/session.h): sources, time, parameters. What is seen is in session_frame.cpp.
#include "pliant/session.h"

#include <fmt/format.h>

#include <limits>

#include "engine/scene_check.h"
#include "engine/session_parts.h"
#include "engine/sources.h"
#include "systems/tool/prepare_tools.h"

namespace pliant {
namespace {

bool finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

Session::Session(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

Result<Session> Session::open(const Scene& scene) {
  auto parts = std::make_unique<Parts>(scene);
  if (Status s = parts->prepare(); !s) return s.error();
  return Session(std::move(parts));
}

const std::vector<std::string>& Session::notes() const {
  return parts_->notes;
}
const std::vector<std::string>& Session::objects() const {
  return parts_->objects;
}
std::vector<std::string> Session::hands() const {
  std::vector<std::string> names;
  for (const SessionHand& hand : parts_->hands) names.push_back(hand.name);
  return names;
}

Status Session::move(const std::string& name, dvec3 position, dquat rotation) {
  SessionHand* const hand = parts_->find_hand(name);
  if (!hand) return parts_->unknown_hand(name);
  const double size = glm::length(rotation);
  if (!finite(position) || !(std::abs(size - 1.0) < 0.01))
    return Error{"Session::move `" + name + "`", "the pose is not finite or its rotation is not of unit length"};
  if (hand->source != HandSource::kPose) {
    if (Status s = parts_->stand_still("Session::move"); !s)
      return Error{"Session::move `" + name + "`", "it had no pose before start(); give it one first"};
    if (Status s = parts_->give(*hand, HandSource::kPose); !s) return s;
  }
  hand->told->write() = {position, rotation};
  hand->told->publish();
  return Done{};
}

Status Session::follow(const std::string& name, Path path) {
  SessionHand* const hand = parts_->find_hand(name);
  if (!hand) return parts_->unknown_hand(name);
  if (Status s = parts_->stand_still("Session::follow"); !s) return s;
  if (path.rows.empty()) return Error{"Session::follow `" + name + "`", "the path has no rows; give it one at least"};
  double before = -std::numeric_limits<double>::infinity();
  for (const PathRow& row : path.rows) {
    if (!finite(row.position) || !(row.time > before) || !std::isfinite(row.time))
      return Error{"Session::follow `" + name + "`", "times must ascend and positions must be finite"};
    before = row.time;
  }
  Path kept = std::move(hand->path);
  hand->path = std::move(path);
  Status given = parts_->give(*hand, HandSource::kPath);
  if (!given) hand->path = std::move(kept);
  return given;
}

Status Session::orbit(const std::string& name) {
  SessionHand* const hand = parts_->find_hand(name);
  if (!hand) return parts_->unknown_hand(name);
  if (Status s = parts_->stand_still("Session::orbit"); !s) return s;
  const auto index = static_cast<unsigned>(hand - parts_->hands.data());
  Path path = orbit_of(parts_->world, hand->entity, index);
  if (path.rows.empty())
    return Error{"Session::orbit `" + name + "`", "finds no surface that gives way; add one with Scene::add_surface"};
  return follow(name, std::move(path));
}

Status Session::connect(const std::string& name, const std::string& driver) {
  const std::size_t colon = driver.find(':');
  auto made = make_driver(driver.substr(0, colon));
  if (!made) return made.error();
  return connect(name, std::move(made).value(), colon == std::string::npos ? "" : driver.substr(colon + 1));
}

Status Session::connect(const std::string& name, std::unique_ptr<Driver> driver, const std::string& id) {
  SessionHand* const hand = parts_->find_hand(name);
  if (!hand) return parts_->unknown_hand(name);
  if (Status s = parts_->stand_still("Session::connect"); !s) return s;
  if (!driver) return Error{"Session::connect `" + name + "`", "the driver is null; give one"};
  if (hand->source != HandSource::kNone && hand->source != HandSource::kLevel)
    return Error{"Session::connect `" + name + "`", "it has a source already; call Session::release() first"};
  try {
    if (Status opened = driver->open(id); !opened) return opened;
    hand->can = driver->capabilities();
  } catch (const std::exception& thrown) {
    return Error{"Session::connect `" + name + "`", std::string("the driver threw: ") + thrown.what()};
  } catch (...) {
    return Error{"Session::connect `" + name + "`", "the driver threw something unknown"};
  }
  hand->driver = std::move(driver);
  return parts_->give(*hand, HandSource::kDriver);
}

Status Session::release(const std::string& name) {
  SessionHand* const hand = parts_->find_hand(name);
  if (!hand) return parts_->unknown_hand(name);
  if (Status s = parts_->stand_still("Session::release"); !s) return s;
  parts_->close_driver(*hand);
  HapticDevice& device = parts_->world.registry.get<HapticDevice>(hand->device);
  device.driver = DriverKind::kNull;
  device.path = {};
  device.status = DeviceStatus::kLost;
  device.force_sent = device.torque_sent = dvec3(0);
  static_cast<DeviceParameters&>(device) = parts_->limits_of(*hand);
  hand->source = HandSource::kNone;
  hand->placed = false;
  return Done{};
}

Status Session::step(std::uint64_t ticks) {
  if (Status s = parts_->stand_still("Session::step"); !s) return s;
  Parts& p = *parts_;
  if (p.lived) return Error{"Session::step", "it has run in real time; call Session::restart() first"};
  const double dt = 1.0 / p.world.simulation.touch_rate;
  const auto end = [&](const std::string& why) {
    let_go(p.world, {p.ticks, dt, p.time});
    p.zero_drivers();
    return Error{"Session::step", "stopped by an exception: " + why};
  };
  try {
    for (std::uint64_t i = 0; i < ticks; ++i) {
      if (p.replayed && p.ticks >= p.replayed->ticks.size())
        return Error{"Session::step", fmt::format("all {} ticks of the recording have run; call Session::restart()",
                                                  p.replayed->ticks.size())};
      const Tick tick = p.replayed ? p.replayed_tick() : Tick{p.ticks, dt, static_cast<double>(p.ticks) * dt};
      p.soft->reach(tick.time);
      p.before(tick);
      p.schedule->run(p.world, tick);
      p.after(tick);
      if (p.recorder && p.ticks % (p.recorder->room() / 2) == 0) p.recorder->drain();
      ++p.ticks;
      p.time = static_cast<double>(p.ticks) * dt;
    }
  } catch (const std::exception& thrown) {
    return end(thrown.what());
  } catch (...) {
    return end("of an unknown kind");
  }
  p.rows.acquire();
  if (p.recorder) p.recorder->drain();
  return Done{};
}

Status Session::start() {
  if (Status s = parts_->stand_still("Session::start"); !s) return s;
  Parts& p = *parts_;
  if (p.ticks > 0) return Error{"Session::start", "it has run before; call Session::restart() first"};
  if (p.replayed) return Error{"Session::start", "a replay runs in lockstep; call Session::step()"};
  limit_tool_ticks(p.world);
  p.lived = true;
  if (p.recorder) p.recorder->start();
  TouchHooks hooks{[&p](Tick tick) { p.before(tick); }, [&p](Tick tick) { p.after(tick); }, [&p](Tick) { p.idle(); },
                   [&p] { p.zero_drivers(); }};
  p.clock = std::make_unique<TouchClock>(p.world, *p.schedule, p.soft.get(), p.world.simulation.touch_rate,
                                         std::numeric_limits<std::uint64_t>::max(), std::move(hooks));
  p.clock->start();
  return Done{};
}

Status Session::pause(bool paused) {
  if (!parts_->clock) return Error{"Session::pause", "the clocks do not run; call Session::start() first"};
  parts_->clock->pause(paused);
  return Done{};
}

bool Session::running() const {
  return parts_->clock && !parts_->clock->done();
}

Status Session::stop() {
  Parts& p = *parts_;
  if (!p.clock) return Done{};
  p.clock->stop();
  p.rows.acquire();
  p.ticks = p.clock->now() + 1;
  p.time = static_cast<double>(p.ticks) / p.world.simulation.touch_rate;
  p.overruns = p.clock->overruns();
  const std::optional<Error> failed = p.clock->error() ? p.clock->error() : p.soft->error();
  p.clock.reset();
  if (failed) return *failed;
  return Done{};
}

Status Session::restart() {
  Status stopped = stop();
  if (parts_->recorder) {
    const Status ended = end_recording();
    if (stopped && !ended) stopped = ended;
  }
  parts_->replayed.reset();
  if (Status s = parts_->prepare(); !s) return s;
  return stopped;
}

double Session::time() const {
  if (!parts_->clock) return parts_->time;
  return static_cast<double>(parts_->clock->now()) / parts_->world.simulation.touch_rate;
}

Status Session::set(const std::string& object, const std::string& key, double value) {
  Parts& p = *parts_;
  const auto surface = p.surfaces.find(object);
  const auto device = p.devices.find(object);
  if (surface == p.surfaces.end() && device == p.devices.end())
    return Error{"`" + object + "`", "is no surface that gives way, no probe and no tool; check the name"};
  std::string known;
  for (std::uint32_t k = 0; k < live_keys().size(); ++k) {
    const LiveKey& live = live_keys()[k];
    if (live.surface ? surface == p.surfaces.end() : device == p.devices.end()) continue;
    known += (known.empty() ? "" : ", ") + std::string(live.key);
    if (key != live.key) continue;
    if (!std::isfinite(value)) return Error{"`" + object + "`: " + key, "is not a number"};
    Edit edit{{}, k, value};
    if (live.surface) {
      if (Status s = check_edit(object, surface->second, p.world.meshes[surface->second.mesh], live, value); !s)
        return s;
      edit.entity = *p.find_object(object);
    } else {
      DeviceParameters changed = device->second;
      changed.*(live.device) = value;
      if (Status s = check_device(object, changed); !s) return s;
      std::swap(device->second, changed);
      const SessionHand& hand = *p.find_hand(object);
      edit.entity = hand.device;
      edit.value = p.limits_of(hand).*(live.device);  // never beyond what its driver can render
      std::swap(device->second, changed);             // until a tick takes it
    }
    if (!p.edits->push(edit)) return Error{"Session::set", "too many values wait for a tick; set fewer at a time"};
    if (live.surface) surface->second.*(live.surface) = value;
    if (live.device) device->second.*(live.device) = value;
    return Done{};
  }
  return Error{"`" + object + "`: " + key, "cannot change between ticks; keys are: " + known};
}

Result<double> Session::get(const std::string& object, const std::string& key) const {
  for (const LiveKey& live : live_keys()) {
    if (key != live.key) continue;
    const auto surface = parts_->surfaces.find(object);
    if (live.surface && surface != parts_->surfaces.end()) return surface->second.*(live.surface);
    const auto device = parts_->devices.find(object);
    if (live.device && device != parts_->devices.end()) return device->second.*(live.device);
  }
  return Error{"`" + object + "`: " + key, "is no key that a session keeps; see Session::set"};
}

}  // namespace pliant
