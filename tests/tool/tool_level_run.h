// A shipped level with a tool, run in lockstep as `pliant run` does.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "content/level_file.h"
#include "systems/prepare_world.h"
#include "systems/schedule.h"
#include "systems/soft/soft_state.h"
#include "systems/tool/tool_step.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant::test {

struct ToolLevelRun {
  static constexpr double kTick = 1e-3;  // [s]
  World world;
  Schedule<World> touch{touch_schedule()}, soft{soft_schedule()};
  std::uint64_t tick = 0, steps = 0;
  double largest = 0.0;  // [N] on the hand

  // `change` is called before the world is prepared.
  template <typename Change>
  ToolLevelRun(const std::string& name, const Change& change) {
    Result<Level> level = load_level(std::string(PLIANT_SOURCE_DIR) + "/content/levels/" + name + ".glb");
    EXPECT_TRUE(level.ok());
    Result<World> spawned = spawn(*level);
    EXPECT_TRUE(spawned.ok());
    world = std::move(spawned).value();
    change(world);
    const Status status = prepare_world(world);
    EXPECT_TRUE(status.ok());
  }
  explicit ToolLevelRun(const std::string& name) : ToolLevelRun(name, [](World&) {}) {}

  // `after_step` is called after each soft step.
  template <typename After>
  void run(double until, const After& after_step) {
    const double step = world.simulation.soft_step;
    for (; static_cast<double>(tick) * kTick < until - 1e-9; ++tick) {
      const double now = static_cast<double>(tick) * kTick;
      for (; static_cast<double>(steps) * step <= now + 1e-9; ++steps) {
        run_soft_step(soft, world, {steps, step, static_cast<double>(steps) * step});
        after_step();
      }
      touch.run(world, {tick, kTick, now});
      for (auto [entity, device] : world.registry.view<const HapticDevice>())
        largest = std::max(largest, length(device.force_sent));
    }
  }
  void run(double until) {
    run(until, [] {});
  }
  // [N] Sum of the normal forces between two bodies in the last soft step; of one with itself: self-contact.
  double pressed(const std::string& a, const std::string& b) const {
    const Entity x = find_by_name(world, a), y = find_by_name(world, b);
    double sum = 0.0;
    for (const ContactPoint& c : world.soft->contacts) {
      const Entity p = world.soft->bodies[c.body_a]->entity, q = world.soft->bodies[c.body_b]->entity;
      if (c.hold.joint < 0 && ((p == x && q == y) || (p == y && q == x))) sum += c.impulse.x;
    }
    return sum / world.soft->impulse_time;
  }
  const Body& body(const std::string& name) const {
    const Entity entity = find_by_name(world, name);
    return **std::find_if(world.soft->bodies.begin(), world.soft->bodies.end(),
                          [&](const auto& b) { return b->entity == entity; });
  }
  dvec3 middle(const std::string& name) const {  // [m]
    dvec3 sum(0.0);
    for (const dvec3& x : body(name).surface_position) sum += x;
    return sum / static_cast<double>(body(name).surface_position.size());
  }
};

}  // namespace pliant::test
