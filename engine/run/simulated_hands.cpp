#include "engine/run/simulated_hands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
      keys += "," + part;  // one too many: parse_simulated reports it
  }
  if (profile.empty()) profile = device_profiles().front().name;
  out.device = profile + keys;
  return out;
}

namespace {

// In device metres, with the workspace's centre at `middle`.
Path local(Path path, dvec3 middle, double scale) {
  for (PathRow& row : path.rows) row.position = (row.position - middle) / scale;
  return path;
}

// The centre of the workspace is put at the centre of the path.
dvec3 middle_of(const Path& path) {
  dvec3 low = path.rows.front().position, high = low;
  for (const PathRow& row : path.rows) low = glm::min(low, row.position), high = glm::max(high, row.position);
  return 0.5 * (low + high);
}

// A sentence if a path exceeds the workspace, else empty.
std::string beyond_stops(const World& world, Entity hand, const SimulatedOptions& options) {
  dvec3 farthest(0);
  for (const PathRow& row : options.will.path.rows) farthest = glm::max(farthest, glm::abs(row.position));
  for (int i = 0; i < 3; ++i) {
    const double reach = options.profile.workspace[i];
    if (!(farthest[i] > reach)) continue;
    const Name* const name = world.registry.find<Name>(hand);
    return fmt::format(
        "the path of `{}` goes {:.0f} mm from its middle along {}, and the workspace of `{}` ends at {:.0f} mm: its "
        "end "
        "stops hold it there; set PLIANT_haptic_device.scale to {:.2g}, or take a larger device",
        name ? name->value : std::string(), 1e3 * farthest[i], "xyz"[i], options.profile.name, 1e3 * reach,
        std::ceil(10.0 * farthest[i] / reach) / 10.0);
  }
  return {};
}

}  // namespace

Status SimulatedHands::add(World& world, Entity hand, const std::string& words) {
  const HandWords parts = hand_words(words);
  auto options = parse_simulated(parts.device);
  if (!options) return options.error();
  HapticDevice& device = world.registry.get<HapticDevice>(device_of(world, hand));
  Held held;
  held.hand = hand;
  held.middle = device.position;
  if (device.path.valid() && !world.paths[device.path].rows.empty()) {
    const Path& path = world.paths[device.path];
    held.middle = middle_of(path);
    options->will.path = local(path, held.middle, device.scale);
    if (!path.repeats) held.seconds = path.rows.back().time;
  } else if (options->will.path.rows.empty()) {
    options->will.path.rows = {{0.0, dvec3(0), device.rotation}};
  }
  if (parts.wrappers.empty() && options->stops)
    if (std::string sentence = beyond_stops(world, hand, *options); !sentence.empty())
      notes_.push_back(std::move(sentence));
  auto simulated = std::make_unique<SimulatedDevice>(std::move(options).value());
  held.device = simulated.get();
  auto chain = wrap(std::move(simulated), parts.wrappers);
  if (!chain) return chain.error();
  held.driver = std::move(chain->driver);
  for (std::string& sentence : chain->notes) notes_.push_back(std::move(sentence));
  device.driver = DriverKind::kExternal;
  device.path = {};
  device.file.clear();
  device.id = std::string(kHandId) + words;
  device.status = DeviceStatus::kLost;
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

}  // namespace pliant
