// A tool's touch tick in a separate world.
#pragma once

#include <gtest/gtest.h>

#include "systems/device/devices.h"
#include "systems/tool/prepare_tools.h"
#include "systems/tool/tool_feedback.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant::test {

inline constexpr double kTick = 1e-3;  // [s]

// One tool whose device the test moves, and whose models the test publishes.
struct TouchStage {
  World world;
  Entity tool, device;
  std::uint64_t ticks = 0;
  HandleModel model;

  explicit TouchStage(const Handle6& settings = {}) {
    tool = world.registry.create();
    device = world.registry.create();
    world.registry.add<Name>(device, {"hand"});
    HapticDevice& d = world.registry.add(device, HapticDevice{});
    d.max_force = 1e9;
    d.max_slew = 1e12;
    world.registry.add<SoftBody>(tool, {});
    world.registry.add<Pose>(tool, {});
    world.registry.add<Handle6>(tool, settings).device = "hand";
    EXPECT_TRUE(prepare_touch(world));
    const Status prepared = prepare_tools(world);
    EXPECT_TRUE(prepared) << (prepared ? "" : prepared.error().what);
    model.contacts.resize(kMaxCondensed, kMaxModes);
    model.soft_step = 1.0 / 60.0;
    model.handle_mass = Matrix6::Identity() * 1e-3;
  }
  ToolTouchState& state() { return *world.tools->tools[0]; }
  HapticDevice& hand() { return world.registry.get<HapticDevice>(device); }
  void publish() {
    ++model.step;
    model.time = static_cast<double>(ticks) * kTick;
    model.contacts.prepare_tick(kTick);
    state().model.write() = model;
    state().model.publish();
  }
  // The force of the next model, of every kind.
  void press(double newton) {
    model.force[1] = model.passed_on[1] = model.linear.force[1] = model.contacts.tissue_force[1] = newton;
  }
  void tick() {
    const Tick now{ticks, kTick, static_cast<double>(ticks) * kTick};
    tool_feedback(world, now);
    write_devices(world, now);
    ++ticks;
  }
  void run(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
};

inline Handle6 coupling(double stiffness) {
  Handle6 handle;
  handle.translation = {stiffness, 0.0};
  handle.rotation = {0.5, 0.005};
  handle.max_force = 1e9;
  return handle;
}

}  // namespace pliant::test
