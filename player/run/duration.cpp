#include "player/run/duration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "components/kinematic.h"
#include "systems/device/hands.h"

namespace pliant {
namespace {

constexpr double kDefaultSeconds = 4.0;     // [s] without a script
constexpr double kLongestDefault = 3600.0;  // [s] limit for a script, unless --seconds gives more
constexpr double kEndless = 1e7;            // [s] a window stays open until it is closed

// A script, motion or recording with its length.
struct Lasting {
  std::string what;
  double seconds = 0.0;
  bool repeats = false;
};

std::string quoted_name(const World& world, Entity entity) {
  const Name* name = world.registry.find<Name>(entity);
  return "`" + (name ? name->value : std::string()) + "`";
}

// [s] until the last key; 0: no motion.
double seconds_of(const PrescribedMotion& motion) {
  double last = 0.0;
  for (const Track* track : {&motion.translation, &motion.rotation, &motion.scale})
    if (track->times.size() > 1) last = std::max(last, motion.repeats ? track->length : track->times.back());
  return motion.speed > 0.0 ? last / motion.speed : 0.0;
}

std::vector<Lasting> all_that_lasts(const World& world, const SimulatedHands& simulated) {
  std::vector<Lasting> all;
  for (const Entity hand : hands(world)) {
    const HapticDevice* device = find_device(world, hand);
    if (!device || device->driver != DriverKind::kScript || !device->path.valid()) continue;
    const Path& path = world.paths[device->path];
    if (!path.rows.empty() && !path.repeats)
      all.push_back({"the script of " + quoted_name(world, hand), path.rows.back().time, false});
  }
  if (simulated.seconds() > 0.0) all.push_back({"the path of a simulated hand", simulated.seconds(), false});
  for (auto [entity, kinematic] : world.registry.view<const Kinematic>()) {
    const PrescribedMotion& motion = world.motions[kinematic.motion];
    if (const double seconds = seconds_of(motion); seconds > 0.0)
      all.push_back({"the motion of " + quoted_name(world, entity), seconds, motion.repeats});
  }
  return all;
}

double default_seconds(const std::vector<Lasting>& all) {
  double longest = 0.0;
  for (const Lasting& each : all)
    if (!each.repeats) longest = std::max(longest, each.seconds);
  return longest > 0.0 ? std::min(longest, kLongestDefault) : kDefaultSeconds;
}

// One note about the longest that is cut.
void say_cut(const std::vector<Lasting>& all, double seconds, double tick, std::vector<std::string>& notes) {
  const Lasting* longest = nullptr;
  std::size_t count = 0;
  for (const Lasting& each : all) {
    if (!(each.seconds > seconds + tick)) continue;
    ++count;
    if (!longest || each.seconds > longest->seconds) longest = &each;
  }
  if (!longest) return;
  const std::string others =
      count > 1 ? fmt::format(" ({} more {} longer than the run, too)", count - 1, count == 2 ? "is" : "are") : "";
  notes.push_back(fmt::format("{} lasts {:.6g} s, and the run ends at {:.6g} s{}; --seconds {:.6g} has all of it",
                              longest->what, longest->seconds, seconds, others,
                              std::ceil(longest->seconds * 1e3) * 1e-3));
}

}  // namespace

RunLength run_length(double seconds, bool windowed, const World& world, const SimulatedHands& simulated,
                     const Recording* replay) {
  const double rate = world.simulation.touch_rate;
  const auto ticks_of = [rate](double s) {
    return static_cast<std::uint64_t>(std::max<long long>(1, std::llround(s * rate)));
  };
  RunLength out;
  if (replay) {
    const std::uint64_t recorded = replay->ticks.size();
    out.ticks = seconds > 0.0 ? std::min(ticks_of(seconds), recorded) : recorded;
    if (seconds > 0.0 && ticks_of(seconds) > recorded)
      out.notes.push_back(fmt::format("the recording ends after {} ticks, before --seconds {}", recorded, seconds));
    if (out.ticks < recorded)
      out.notes.push_back(
          fmt::format("the recording has {} ticks, and the run ends after {}; leave out --seconds for "
                      "all of it",
                      recorded, out.ticks));
    return out;
  }
  const std::vector<Lasting> all = all_that_lasts(world, simulated);
  if (!(seconds > 0.0)) seconds = windowed ? kEndless : default_seconds(all);
  out.ticks = ticks_of(seconds);
  say_cut(all, seconds, 1.0 / rate, out.notes);
  return out;
}

}  // namespace pliant
