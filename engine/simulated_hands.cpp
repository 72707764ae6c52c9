#include "engine/simulated_hands.h"

#include <fmt/format.h>

#include <algorithm>

#include "devices/guard/guard.h"
#include "devices/spec.h"
#include "devices/wrappers/chain.h"
#include "systems/device/hands.h"

namespace pliant {

HandWords hand_words(const std::string& words) {
  HandWords out;
  const std::size_t bar = words.find('|');
  if (bar != std::string::npos) out.wrappers = words.substr(bar + 1);
  std::string profile, keys;
  for (const std::string& part : split(words.substr(0, bar), ',')) {
    if (part.find('=') != std::string::npos)
      keys += "," + part;
    else if (profile.empty() && find_device_profile(part))
      profile = part;
    else if (out.file.empty())
      out.file = part;
    else
      keys += "," + part;  // one too many: parse_simulated says so
  }
  if (profile.empty()) profile = device_profiles().front().name;
  out.device = profile + keys;
  return out;
}

namespace {

// The stiffest surface, before vertices and depth make it stiffer.
std::pair<double, std::string> stiffest_surface(const World& world) {
  std::pair<double, std::string> stiffest{0.0, ""};
  for (auto [entity, surface] : world.registry.view<const Deformable>()) {
    if (!(surface.stiffness > stiffest.first)) continue;
    const Name* name = world.registry.find<Name>(entity);
    stiffest = {surface.stiffness, name ? name->value : std::string()};
  }
  return stiffest;
}

}  // namespace

double softening(const World& world, const DeviceCapabilities& can) {
  const double stiffest = stiffest_surface(world).first;
  return can.max_stiffness > 0.0 && stiffest > can.max_stiffness ? can.max_stiffness / stiffest : 1.0;
}

DeviceCapabilities before_softening(DeviceCapabilities can, double share) {
  can.max_stiffness /= share;
  can.max_force /= share;
  return can;
}

std::string stiffness_note(const World& world, const std::string& hand, const DeviceCapabilities& can) {
  const double share = softening(world, can);
  if (share == 1.0) return {};
  const auto [stiffest, its] = stiffest_surface(world);
  return fmt::format(
      "`{}` has {:g} N/m, and the device of `{}` renders at most {:.3g} N/m stably: it gets {:.0f} % of the force; "
      "give "
      "the surface less stiffness, or take a stiffer or faster device",
      its, stiffest, hand, can.max_stiffness, 100.0 * share);
}

Status SimulatedHands::add(World& world, Entity hand, const std::string& name, const std::string& words,
                           bool lockstep) {
  const HandWords parts = hand_words(words);
  auto options = parse_simulated(parts.device);
  if (!options) return options.error();
  const Entity entity = device_of(world, hand);
  HapticDevice& device = world.registry.get<HapticDevice>(entity);
  Held held;
  held.device = entity;
  held.hand = hand;
  if (device.path.valid()) {
    options->will.path = world.paths[device.path];
    if (!options->will.path.repeats && !options->will.path.rows.empty())
      held.seconds = options->will.path.rows.back().time;
  } else if (options->will.path.rows.empty()) {
    options->will.path.rows = {{0.0, device.position, device.rotation}};
  }
  options->clock = lockstep ? DeviceClock::kTick : DeviceClock::kWall;
  if (lockstep) options->profile.rate = world.simulation.touch_rate;
  auto chain = wrap(std::make_unique<SimulatedDevice>(std::move(options).value()), parts.wrappers);
  if (!chain) return chain.error();
  held.driver = std::move(chain->driver);
  for (std::string& sentence : chain->notes) notes_.push_back(std::move(sentence));

  device.driver = DriverKind::kExternal;
  device.path = {};
  device.file.clear();
  device.id = std::string(kHandId) + words;
  device.can = held.driver->capabilities();
  device.can.max_stiffness = stable_stiffness(device.can, device.can.rate);
  device.workspace = 1.0;  // paths are in metres of the world
  device.status = DeviceStatus::kLost;
  held.share = softening(world, device.can);
  if (std::string sentence = stiffness_note(world, name, device.can); !sentence.empty())
    notes_.push_back(std::move(sentence));
  device.can = before_softening(device.can, held.share);
  hands_.push_back(std::move(held));
  return Done{};
}

bool SimulatedHands::moves(Entity hand) const {
  return std::any_of(hands_.begin(), hands_.end(), [&](const Held& held) { return held.hand == hand; });
}

double SimulatedHands::seconds() const {
  double longest = 0.0;
  for (const Held& held : hands_) longest = std::max(longest, held.seconds);
  return longest;
}

Status SimulatedHands::open() {
  open_ = true;
  for (Held& held : hands_) {
    held.ready = false;
    if (const Status opened = held.driver->open(""); !opened) return opened;
  }
  return Done{};
}

void SimulatedHands::read(World& world, Tick tick) {
  for (Held& held : hands_) {
    HapticDevice& device = world.registry.get<HapticDevice>(held.device);
    DeviceSample sample;
    if (held.driver->read(sample)) {
      device.position = sample.position;
      device.rotation = sample.rotation;
      device.sensed_at = tick.time;
      held.ready = sample.ready;
    }
    device.status = held.ready ? DeviceStatus::kReady : DeviceStatus::kLost;
  }
}

void SimulatedHands::write(World& world) {
  for (Held& held : hands_) {
    const HapticDevice& device = world.registry.get<HapticDevice>(held.device);
    held.driver->write({held.share * device.force_sent, held.share * device.torque_sent, 0.0});
  }
}

void SimulatedHands::let_go(World& world) {
  for (Held& held : hands_) {
    HapticDevice& device = world.registry.get<HapticDevice>(held.device);
    device.force_sent = device.torque_sent = dvec3(0);
    held.driver->write({});
  }
}

void SimulatedHands::idle() {
  DeviceSample sample;
  for (Held& held : hands_) {
    held.driver->read(sample);
    held.driver->write({});
  }
}

void SimulatedHands::close() noexcept {
  if (!open_) return;
  open_ = false;
  for (Held& held : hands_) {
    try {
      held.driver->write({});
      held.driver->close();
    } catch (...) {  // gone all the same
    }
  }
}

}  // namespace pliant
