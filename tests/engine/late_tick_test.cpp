// A late touch clock: ticks are missed while everything moves on. On the shipped levels, with their scripts and with
// orbits, in a virtual clock that jumps: the force is the same as without the jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "content/level_file.h"
#include "engine/run/driver_link.h"
#include "engine/run/soft_clock.h"
#include "engine/run/sources.h"
#include "systems/device/hands.h"
#include "systems/device/mouse.h"
#include "systems/device/path.h"
#include "systems/prepare_world.h"
#include "systems/schedule.h"

namespace pliant {
namespace {

constexpr double kDt = 1e-3;  // [s]

enum class Led : std::uint8_t { kScript, kOrbit, kMouse, kDriver, kServo };

// Where a device is goes on by time, whoever is late. A driver that is not asked keeps its last force.
class PathDriver final : public Driver {
 public:
  PathDriver(const Path& path, bool served) : path_(path), served_(served) {}
  Status open(const std::string&) override { return Done{}; }
  DeviceCapabilities capabilities() const override {
    return {.senses_rotation = true, .renders_torque = true, .max_force = 3.3, .rate = served_ ? 1.0 / kDt : 0.0};
  }
  bool read(DeviceSample& sample) override {
    const PathRow row = sample_path(path_, served_ ? kDt * static_cast<double>(periods_++) : now);
    sample = {};
    sample.position = row.position;
    sample.rotation = row.rotation;
    return true;
  }
  void write(const DeviceWrench& wrench) override {
    written = wrench.force;
    if (served_) all.push_back(wrench.force);
  }
  void close() override {}

  double now = 0.0;        // [s]
  dvec3 written{0};        // [N]
  std::vector<dvec3> all;  // [N] of a servo's periods

 private:
  Path path_;
  bool served_;
  std::uint64_t periods_ = 0;
};

struct LateWorld {
  World world;
  std::vector<Entity> devices, hands_of;
  std::unique_ptr<SoftClock> soft;
  std::unique_ptr<Schedule<World>> schedule;
  std::vector<DriverLink> links;
  std::vector<PathDriver*> drivers;
  Path pointed;  // of the mouse
  Led led;
  std::uint64_t next = 0;

  LateWorld(const std::string& name, Led who, std::uint64_t ticks) : led(who) {
    const std::string folder = PLIANT_SOURCE_DIR "/content/levels/";
    auto level = load_level(folder + name);
    EXPECT_TRUE(level) << (level ? "" : level.error().message());
    auto made = spawn(*level);
    EXPECT_TRUE(made) << (made ? "" : made.error().message());
    world = std::move(made).value();
    for (const Entity hand : hands(world)) devices.push_back(device_of(world, hand)), hands_of.push_back(hand);
    if (led == Led::kOrbit)
      for (const Entity device : devices) of(device).driver = DriverKind::kOrbit;
    const Status prepared = prepare_world(world);
    EXPECT_TRUE(prepared) << (prepared ? "" : prepared.error().message());
    static_cast<void>(make_orbits(world));
    if (led == Led::kMouse) {
      pointed = world.paths[of(devices[0]).path];
      of(devices[0]).driver = DriverKind::kMouse;
      of(devices[0]).path = {};
      add_mouse(world, sample_path(pointed, 0.0).position);
    }
    if (led == Led::kDriver || led == Led::kServo) connect(ticks);
    soft = std::make_unique<SoftClock>(world);
    schedule = std::make_unique<Schedule<World>>(touch_schedule());
  }
  HapticDevice& of(Entity device) { return world.registry.get<HapticDevice>(device); }
  void connect(std::uint64_t ticks) {
    for (const Entity entity : devices) {
      HapticDevice& device = of(entity);
      auto driver = std::make_unique<PathDriver>(world.paths[device.path], led == Led::kServo);
      driver->all.reserve(ticks + 8);
      drivers.push_back(driver.get());
      device.driver = DriverKind::kExternal;
      device.path = {};
      device.scale = 1.0;
      DriverLink link;
      EXPECT_TRUE(link.connect(std::move(driver), "", "test"));
      link.begin(device, device.rotation, dvec3(0));
      links.push_back(std::move(link));
    }
  }
  // The tick of this index, those before it since the last having been missed. [N] of each device.
  std::vector<dvec3> tick(std::uint64_t index) {
    const Tick now{index, kDt, static_cast<double>(index) * kDt, static_cast<double>(index - next) * kDt};
    // Pictures are drawn meanwhile: the newest pose of every 16 ms is there.
    if (led == Led::kMouse && (index == 0 || index / 16 != (next - 1) / 16)) {
      world.mouse->samples.write() = {sample_path(pointed, static_cast<double>(index / 16 * 16) * kDt).position, false};
      world.mouse->samples.publish();
    }
    next = index + 1;
    soft->reach(now.time);
    for (std::size_t d = 0; d < links.size(); ++d) {
      drivers[d]->now = now.time;
      links[d].read(of(devices[d]), now);
    }
    schedule->run(world, now);
    for (std::size_t d = 0; d < links.size(); ++d) links[d].write(world, hands_of[d], devices[d], now);
    std::vector<dvec3> forces;
    for (std::size_t d = 0; d < devices.size(); ++d)
      forces.push_back(links.empty() ? of(devices[d]).force_sent : drivers[d]->written);
    return forces;
  }
};

// Of each device, what left in each tick, or in each period of its servo; nothing where there was none.
using Sent = std::vector<std::vector<std::optional<dvec3>>>;
Sent run(const std::string& level, Led led, std::uint64_t ticks, const std::function<bool(std::uint64_t)>& missed) {
  LateWorld late(level, led, ticks);
  Sent sent(late.devices.size());
  for (auto& of_one : sent) of_one.resize(ticks);
  for (std::uint64_t i = 0; i < ticks; ++i) {
    if (missed(i)) continue;
    const std::vector<dvec3> forces = late.tick(i);
    for (std::size_t d = 0; d < forces.size(); ++d) sent[d][i] = forces[d];
  }
  for (std::size_t d = 0; d < late.drivers.size() && led == Led::kServo; ++d)
    for (std::uint64_t i = 0; i < std::min<std::uint64_t>(ticks, late.drivers[d]->all.size()); ++i)
      sent[d][i] = late.drivers[d]->all[i];
  return sent;
}

struct Late {
  double over = 0.0, step = 0.0;  // [N] beyond what leaves in time, about then: the force, and its rise in a tick
  double air = 0.0;               // [N] where nothing leaves in time, about then
  int in_air = 0, touching = 0;   // ticks
};
Late judge(const Sent& in_time, const Sent& late, std::uint64_t missed) {
  Late worst;
  for (std::size_t d = 0; d < late.size(); ++d) {
    const std::uint64_t ticks = late[d].size();
    std::optional<dvec3> last;
    for (std::uint64_t i = 0; i < ticks; ++i) {
      if (!late[d][i]) continue;
      // A force that is late by as much as was missed is none too many.
      double most = 0.0, rise = 0.0, here = 0.0;
      const std::uint64_t from = i > 2 * missed + 30 ? i - 2 * missed - 30 : 0;
      for (std::uint64_t k = from; k < std::min<std::uint64_t>(ticks, i + 30); ++k) {
        const double size = length(*in_time[d][k]);
        most = std::max(most, size);
        if (k + 15 > i && k < i + 15) here = std::max(here, size);
        if (k > 0) rise = std::max(rise, size - length(*in_time[d][k - 1]));
      }
      const double size = length(*late[d][i]);
      worst.over = std::max(worst.over, size - most);
      if (last) worst.step = std::max(worst.step, size - length(*last) - rise);
      if (here < 1e-3) ++worst.in_air, worst.air = std::max(worst.air, size);
      worst.touching += size > 0.02;
      last = late[d][i];
    }
  }
  return worst;
}

// `step` [N]: how much faster a force may come back, in a tick, than any in time grows. What a mouse leads is not felt,
// and is as uneven as its pictures.
void compare(const std::string& level, Led led, std::uint64_t ticks, double most_step = 0.1) {
  const Sent in_time = run(level, led, ticks, [](std::uint64_t) { return false; });
  for (const std::uint64_t missed : {1u, 2u, 5u, 9u, 20u, 50u, 200u, 300u, 500u}) {
    const std::uint64_t between = led == Led::kServo ? 397 : 97 + missed / 2;
    const Late worst = judge(
        in_time, run(level, led, ticks, [&](std::uint64_t i) { return i % (missed + between) >= between; }), missed);
    const std::string what = level + ", " + std::to_string(missed) + " ms, led by " + std::to_string(int(led));
    const bool mouse = led == Led::kMouse;
    const double of_mouse = missed < 20 ? 1.5 : 0.8;  // a short stall is not eased
    EXPECT_LT(worst.over, mouse ? of_mouse : 0.1) << what;
    EXPECT_LT(worst.step, mouse ? of_mouse : missed < 50 ? most_step : 0.2) << what;
    EXPECT_LT(worst.air, mouse ? 0.3 : 0.01) << what;
    if (missed < 9 && !mouse) EXPECT_GT(worst.touching, 100) << what << ": nothing was pressed";
  }
}

TEST(LateTick, ToolsFeelNoBlowWhateverWasMissed) {
  compare("instrument.glb", Led::kOrbit, 1500);
  compare("instrument.glb", Led::kScript, 1500);
}

TEST(LateTick, ProbesFeelNoBlowWhateverWasMissed) {
  compare("three_probes.glb", Led::kOrbit, 1500);
  compare("three_probes.glb", Led::kScript, 2500, 0.2);
  compare("turning_ball.glb", Led::kScript, 1500);
}

TEST(LateTick, SoftHandsFeelNoBlowWhateverWasMissed) {
  compare("hand.glb", Led::kScript, 2200);
}

TEST(LateTick, ToolsOnATowerFeelNoBlowWhateverWasMissed) {
  compare("stack.glb", Led::kScript, 2200);
}

// A device that keeps its last wrench is sent nothing in free air, from the first tick after a stall on.
TEST(LateTick, DriversWithoutAServoAreSentNoBlowWhateverWasMissed) {
  compare("instrument.glb", Led::kDriver, 1500);
  compare("turning_ball.glb", Led::kDriver, 1500);
}

TEST(LateTick, ADriverOfAHandWithoutAServoIsSentNoBlowWhateverWasMissed) {
  compare("hand.glb", Led::kDriver, 2200);
}

TEST(LateTick, ADriverAtATowerWithoutAServoIsSentNoBlowWhateverWasMissed) {
  compare("stack.glb", Led::kDriver, 2200);
}

// Every period of the servo is judged, those in the stall among them.
TEST(LateTick, DriversWithAServoAreSentNoBlowWhateverWasMissed) {
  compare("instrument.glb", Led::kServo, 1500);
  compare("turning_ball.glb", Led::kServo, 1500);
}

TEST(LateTick, ADriverOfAHandWithAServoIsSentNoBlowWhateverWasMissed) {
  compare("hand.glb", Led::kServo, 2200);
}

TEST(LateTick, ADriverAtATowerWithAServoIsSentNoBlowWhateverWasMissed) {
  compare("stack.glb", Led::kServo, 2200);
}

TEST(LateTick, AMouseThatWasNotHeardForLongIsNoBlow) {
  compare("instrument.glb", Led::kMouse, 1500);
  compare("hand.glb", Led::kMouse, 1500);
  compare("stack.glb", Led::kMouse, 1500);
}

}  // namespace
}  // namespace pliant
