// A late touch clock: ticks are missed while everything moves on. On the shipped levels, with their scripts and with
// orbits, in a virtual clock that jumps: the force is the same as without the jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "content/level_file.h"
#include "engine/soft_clock.h"
#include "engine/sources.h"
#include "systems/device/hands.h"
#include "systems/schedule.h"
#include "systems/soft/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/touch/prepare.h"

namespace pliant {
namespace {

constexpr double kDt = 1e-3;  // [s]

struct LateWorld {
  World world;
  std::vector<Entity> devices;
  std::unique_ptr<SoftClock> soft;
  std::unique_ptr<Schedule<World>> schedule;
  std::uint64_t next = 0;

  LateWorld(const std::string& name, bool orbits, DriverKind driver = DriverKind::kScript) {
    const std::string folder = PLIANT_SOURCE_DIR "/content/levels/";
    auto level = load_level(folder + name);
    EXPECT_TRUE(level) << (level ? "" : level.error().message());
    auto made = spawn(*level);
    EXPECT_TRUE(made) << (made ? "" : made.error().message());
    world = std::move(made).value();
    for (const Entity hand : hands(world)) devices.push_back(device_of(world, hand));
    if (orbits)
      for (const Entity device : devices) world.registry.get<HapticDevice>(device).driver = DriverKind::kOrbit;
    for (const auto prepare_system : {prepare_touch, prepare_tools, prepare_soft}) {
      const Status prepared = prepare_system(world);
      EXPECT_TRUE(prepared) << (prepared ? "" : prepared.error().message());
    }
    static_cast<void>(make_orbits(world));
    if (driver == DriverKind::kExternal)
      for (const Entity device : devices) world.registry.get<HapticDevice>(device).driver = driver;
    soft = std::make_unique<SoftClock>(world);
    schedule = std::make_unique<Schedule<World>>(touch_schedule());
  }
  // The tick of this index, those before it since the last having been missed. [N] of each device.
  std::vector<dvec3> tick(std::uint64_t index) {
    const Tick now{index, kDt, static_cast<double>(index) * kDt, static_cast<double>(index - next) * kDt};
    next = index + 1;
    soft->reach(now.time);
    schedule->run(world, now);
    std::vector<dvec3> forces;
    for (const Entity device : devices) forces.push_back(world.registry.get<HapticDevice>(device).force_sent);
    return forces;
  }
};

// A stall of `missed` ticks after every `between`.
bool is_missed(std::uint64_t i, std::uint64_t missed, std::uint64_t between) {
  return i % (missed + between) >= between;
}

void compare(const std::string& level, bool orbits, std::uint64_t ticks, DriverKind driver) {
  std::vector<std::vector<dvec3>> in_time;
  LateWorld reference(level, orbits, driver);
  for (std::uint64_t i = 0; i < ticks; ++i) in_time.push_back(reference.tick(i));
  for (const std::uint64_t missed : {1u, 5u, 9u, 20u, 50u, 300u}) {
    const std::uint64_t between = 97 + missed / 2;
    LateWorld late(level, orbits, driver);
    double worst = 0.0, step = 0.0;
    std::vector<dvec3> last;
    for (std::uint64_t i = 0; i < ticks; ++i) {
      if (is_missed(i, missed, between)) continue;
      const std::vector<dvec3> forces = late.tick(i);
      for (std::size_t d = 0; d < forces.size(); ++d) {
        // Bounds from the on-time run around this tick: the force may be late by the missed time.
        double most = 0.0, rise = 0.0;
        const std::uint64_t from = i > 2 * missed + 30 ? i - 2 * missed - 30 : 0;
        for (std::uint64_t k = from; k < std::min<std::uint64_t>(ticks, i + 30); ++k) {
          most = std::max(most, length(in_time[k][d]));
          if (k > 0) rise = std::max(rise, length(in_time[k][d]) - length(in_time[k - 1][d]));
        }
        worst = std::max(worst, length(forces[d]) - most);
        if (!last.empty()) step = std::max(step, length(forces[d]) - length(last[d]) - rise);
      }
      last = forces;
    }
    // After a long stall, an object in contact continues from an unobserved state: the force is bounded, but not the
    // same.
    const double most_over = missed < 50 ? 0.1 : 0.3;  // [N]
    EXPECT_LT(worst, most_over) << level << ", " << missed << " ms, orbits " << orbits;
    EXPECT_LT(step, most_over) << level << ", " << missed << " ms, orbits " << orbits;
  }
}

TEST(LateTick, ToolsFeelNoBlowWhateverWasMissed) {
  compare("instrument.glb", true, 1500, DriverKind::kScript);
  compare("instrument.glb", false, 1500, DriverKind::kExternal);
}

TEST(LateTick, ProbesFeelNoBlowWhateverWasMissed) {
  compare("three_probes.glb", true, 1500, DriverKind::kScript);
  compare("turning_ball.glb", false, 1500, DriverKind::kExternal);
}

}  // namespace
}  // namespace pliant
