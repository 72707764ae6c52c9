// The tool's touch tick in a separate world: stability against the table of exact limits, smooth updates, aging models,
// missed budgets, no allocations.
#include "systems/tool/tool_feedback.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/device/devices.h"
#include "systems/safety/safety.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/tool/prepare_tools.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/prepare/prepare.h"
#include "tests/tool/press_scene.h"

#ifndef PLIANT_SANITIZED
// Counts every allocation, including Eigen's; the sanitizers have their own.
namespace {
std::atomic<std::uint64_t> g_allocations{0};
}
extern "C" void* __libc_malloc(std::size_t);
extern "C" void* malloc(std::size_t size) {
  ++g_allocations;
  return __libc_malloc(size);
}
#endif

namespace pliant {
namespace {

constexpr double kTick = 1e-3;  // [s]

// One tool whose device the test moves, and whose models the test publishes.
struct Stage {
  World world;
  Entity tool, device;
  std::uint64_t ticks = 0;
  HandleModel model;

  explicit Stage(const Handle6& settings = {}) {
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
  void tick() {
    const Tick now{ticks, kTick, static_cast<double>(ticks) * kTick};
    tool_feedback(world, now);
    write_devices(world, now);
    ++ticks;
  }
};

Handle6 coupling(double stiffness) {
  Handle6 handle;
  handle.translation = {stiffness, 0.0};
  handle.rotation = {0.5, 0.005};
  handle.max_force = 1e9;
  return handle;
}

// [m] how far the device has swung in the last half of three seconds, from 1 mm inside the coupling. The handle is
// against a rigid wall, so that the coupling is all that the device feels; device: exact mass and damper.
double swing(double mass, double damping, double stiffness) {
  Stage stage(coupling(stiffness));
  stage.state().wanted = ToolForce::kLinear;
  stage.model.linear.stiffness = 1e12 * Matrix6::Identity();
  const double E = std::exp(-damping / mass * kTick);
  double x = 1e-3, v = 0.0, largest = 0.0;
  for (int i = 0; i < 3000; ++i) {
    if (i % 16 == 0) stage.publish();
    stage.hand().position.x = x;
    stage.tick();
    const double force = stage.state().device_wrench[0], u = force / damping;
    x += u * kTick + (v - u) * (1 - E) * mass / damping;
    v = u + (v - u) * E;
    if (i >= 1500) largest = std::max(largest, std::abs(x));
    if (!(std::abs(x) < 1e3)) return 1e3;
  }
  return largest;
}

TEST(ToolFeedback, IsStableAgainstARigidWallUpToTheExactLimitOfTheDevice) {
  struct Row {
    double mass, damping, limit;  // [kg], [N s/m], [N/m] methods.md 3.7
  };
  for (const Row& row : {Row{.045, .05, 100}, Row{.045, .1, 200}, Row{.045, .5, 1002}, Row{.1, 1, 2003}}) {
    EXPECT_LT(swing(row.mass, row.damping, 0.97 * row.limit), 1e-3) << row.limit;
    EXPECT_GT(swing(row.mass, row.damping, 1.03 * row.limit), 1e-3) << row.limit;
  }
}

// The clock skips 12 ticks while the device continues at 50 mm/s: it has moved 0.65 mm in the next tick. If this
// counted as 13 times its speed, the coupling's damper alone would push 1.2 N.
TEST(ToolFeedback, ALateTickIsNoBlow) {
  Handle6 settings = coupling(200.0);
  settings.translation[1] = 2.0;
  Stage stage(settings);
  stage.state().wanted = ToolForce::kLinear;
  stage.publish();
  const double speed = 0.05;
  const auto follow = [&] {
    stage.hand().position.x = speed * static_cast<double>(stage.ticks) * kTick;
    stage.hand().rotation = rotation_of(dvec3(0, 0, 0.4 * static_cast<double>(stage.ticks) * kTick));
    stage.tick();
  };
  while (stage.ticks < 40) follow();
  EXPECT_NEAR(stage.state().sensed.velocity[0], speed, 1e-9);
  const double before = std::abs(stage.state().device_wrench[0]);
  stage.ticks += 12;
  follow();
  EXPECT_NEAR(stage.state().sensed.velocity[0], speed, 1e-9);
  EXPECT_NEAR(stage.state().sensed.velocity[5], 0.4, 1e-9);
  // The spring responds to the displacement of 13 ticks, no more.
  EXPECT_LT(std::abs(stage.state().device_wrench[0]), before + 1.01 * 200.0 * 13 * kTick * speed);
}

TEST(ToolFeedback, AModelsUpdateIsNoJump) {
  for (const ToolForce mode : {ToolForce::kHeld, ToolForce::kLinear, ToolForce::kContacts}) {
    Stage stage(coupling(200.0));
    stage.state().wanted = mode;
    const auto press = [&](double newton) {
      stage.model.force.setZero();
      stage.model.force[1] = stage.model.linear.force[1] = stage.model.contacts.tissue_force[1] = newton;
    };
    press(0.5);
    stage.publish();
    for (int i = 0; i < 40; ++i) stage.tick();
    EXPECT_NEAR(stage.state().wrench[1], 0.5, 1e-9);
    press(1.5);
    stage.publish();
    double before = stage.state().wrench[1], most = 0.0;
    for (int i = 0; i < 40; ++i) {
      stage.tick();
      most = std::max(most, std::abs(stage.state().wrench[1] - before));
      before = stage.state().wrench[1];
    }
    // Fading evenly over 3/8 T = 6.3 ms changes 0.16 of the difference in a tick.
    EXPECT_LT(most, kTick * 60.0 / kJoinShare + 1e-9);
    EXPECT_NEAR(before, 1.5, 2e-3);
  }
}

// A transfer that begins anew with every model must not keep the force of the first.
TEST(ToolFeedback, ModelsThatComeWithEveryTickAreFelt) {
  for (const ToolForce mode : {ToolForce::kHeld, ToolForce::kLinear, ToolForce::kContacts})
    for (const double ticks : {0.5, 1.0, 1.5, 2.0, 2.6}) {
      Stage stage(coupling(200.0));
      stage.state().wanted = mode;
      stage.model.soft_step = ticks * kTick;
      double due = 0.0;
      for (int i = 0; i < 60; ++i) {
        if (i >= due) {
          const double newton = 0.02 * std::min(i, 50);
          stage.model.force.setZero();
          stage.model.force[1] = stage.model.linear.force[1] = stage.model.contacts.tissue_force[1] = newton;
          stage.publish();
          due += std::max(1.0, ticks);
        }
        stage.tick();
      }
      EXPECT_NEAR(stage.state().wrench[1], 1.0, 1e-3) << ticks << ' ' << static_cast<int>(mode);
    }
}

constexpr std::size_t kUpdateTicks = 6;  // an update's own tick and the five after it

// The largest change in the ticks of the update at tick `at`, over the largest in the others `around` it.
double jump_over_slope(const std::vector<dvec3>& force, std::size_t at, std::size_t before, std::size_t after) {
  const auto change = [&](std::size_t i) { return length(force[i] - force[i - 1]); };
  double jump = 0.0, slope = 0.0;
  for (std::size_t i = before + kUpdateTicks; i < after; ++i)
    if (i < at || i >= at + kUpdateTicks) slope = std::max(slope, change(i));
  for (std::size_t i = at; i < at + kUpdateTicks; ++i) jump = std::max(jump, change(i));
  return jump / slope;
}

// A soft finger is pressed into a soft block on the ground, then drawn along it.
TEST(ToolFeedback, NoTickAfterAModelsUpdateChangesTheForceBeyondTwiceTheSlope) {
  scenes::ToolStage stage(1.0 / 60.0);
  RigidBody floor;
  floor.fixed = true;
  stage.add_rigid(scenes::box(dvec3(0.3, 0.02, 0.3)), floor, Pose{dvec3(0, -0.01, 0), {1, 0, 0, 0}});
  SoftBody tissue = firm_tissue();
  tissue.friction_static = tissue.friction_sliding = 0.4;
  stage.add_soft(tets::box(4, 2, 4, dvec3(-0.04, 0.0, -0.04), dvec3(0.04, 0.03, 0.04)), tissue, Pose{});
  TetMesh finger = tets::box(2, 3, 2, dvec3(-0.01, -0.015, -0.01), dvec3(0.01, 0.015, 0.01));
  tets::hold(
      finger, [](dvec3) { return false; }, [](dvec3 x) { return x.y > 6e-3; });
  const Handle6 handle;
  const Entity tool = stage.add_soft(finger, tissue, Pose{dvec3(0, 0.047, 0), {1, 0, 0, 0}}, &handle);
  stage.prepare();
  const ToolTouchState& state = *stage.world.tools->tools[0];
  std::vector<dvec3> force;
  std::vector<std::size_t> updates;
  std::uint64_t newest = 0;
  const auto look = [&] {
    if (state.model.read().step != newest) updates.push_back(force.size());
    newest = state.model.read().step;
    force.push_back(linear(state.wrench));
  };
  stage.lead(tool, dvec3(0, 0.047, 0), 0.1, look);
  stage.lead(tool, dvec3(0, 0.037, 0), 0.31, look);  // so that the device turns between two updates
  stage.lead(tool, dvec3(0.02, 0.037, 0.005), 0.4, look);
  ASSERT_GT(length(force.back()), 0.1);
  const std::size_t touched = 200;
  int seen = 0;
  for (std::size_t k = 1; k + 1 < updates.size(); ++k) {
    if (updates[k - 1] < touched) continue;
    EXPECT_LT(jump_over_slope(force, updates[k], updates[k - 1], updates[k + 1]), 2.0) << updates[k];
    ++seen;
  }
  EXPECT_GT(seen, 30);
}

TEST(ToolFeedback, AModelThatGrewOldFadesToNothing) {
  for (const ToolForce mode : {ToolForce::kHeld, ToolForce::kLinear, ToolForce::kContacts}) {
    Stage stage(coupling(200.0));
    stage.state().wanted = mode;
    stage.model.force[1] = stage.model.linear.force[1] = stage.model.contacts.tissue_force[1] = 1.0;
    stage.publish();
    double before = 1.0, most = 0.0;
    for (int i = 0; i < 150; ++i) {
      stage.tick();
      if (i <= 50) EXPECT_NEAR(stage.state().wrench[1], 1.0, 1e-9) << i;  // 3 T = 50 ms
      most = std::max(most, std::abs(stage.state().wrench[1] - before));
      before = stage.state().wrench[1];
    }
    EXPECT_LT(before, 1e-3);
    EXPECT_LT(most, 0.25);
  }
}

// A finger of many contacts, its last soft step as the model.
struct Pressing {
  PressScene scene;
  Pose at;
  explicit Pressing(Stage& stage, double friction) : scene(firm_tissue(), firm_handle(), friction, 4, 5) {
    at = scene.settle(1.0 / 60.0, 2e-3, 30, kTick, stage.model);
    stage.hand().position = at.position;
    stage.hand().rotation = at.rotation;
  }
};

TEST(ToolFeedback, LateTicksLeaveTheForceToTheLinearModelWithoutAJump) {
  Stage stage(firm_handle());
  Pressing pressing(stage, 0.5);
  ASSERT_GE(stage.model.contacts.count, 30);
  stage.publish();
  for (int i = 0; i < 5; ++i) stage.tick();
  EXPECT_EQ(stage.state().used, ToolForce::kContacts);
  const Vector6 before = stage.state().wrench;
  stage.state().limits.budget_ns = 1;
  stage.state().limits.tolerance = 0.0;
  for (int i = 0; i < kLateTicks; ++i) stage.tick();
  EXPECT_EQ(stage.state().used, ToolForce::kLinear);
  stage.tick();
  EXPECT_LT((stage.state().wrench - before).norm(), 1e-3 * before.norm());
  stage.state().limits.budget_ns = 0;
  stage.publish();
  stage.tick();
  EXPECT_EQ(stage.state().used, ToolForce::kContacts);
}

TEST(ToolFeedback, ATickAllocatesNothing) {
#ifdef PLIANT_SANITIZED
  GTEST_SKIP() << "the sanitizers allocate themselves";
#else
  for (const ToolForce mode : {ToolForce::kHeld, ToolForce::kLinear, ToolForce::kContacts}) {
    Stage stage(firm_handle());
    Pressing pressing(stage, 0.5);
    stage.state().wanted = mode;
    stage.publish();
    stage.tick();
    std::uint64_t allocated = 0;
    for (int i = 0; i < 100; ++i) {
      stage.hand().position.x += 5e-5;
      if (i == 50) stage.publish();
      const std::uint64_t before = g_allocations;
      stage.tick();
      allocated += g_allocations - before;
    }
    EXPECT_EQ(allocated, 0u);
    EXPECT_GT(stage.state().wrench.norm(), 0.1);
  }
#endif
}

TEST(ToolFeedback, NothingIsFeltOfADeviceThatIsLost) {
  Stage stage(coupling(200.0));
  stage.model.force[1] = stage.model.linear.force[1] = stage.model.contacts.tissue_force[1] = 0.1;
  stage.publish();
  for (int i = 0; i < 40; ++i) stage.tick();
  EXPECT_GT(length(stage.hand().force_sent), 0.05);
  stage.hand().status = DeviceStatus::kLost;
  stage.tick();
  EXPECT_EQ(length(stage.hand().force_sent), 0.0);
  EXPECT_EQ(length(stage.hand().torque_sent), 0.0);
  stage.hand().status = DeviceStatus::kReady;
  stage.hand().position.x = std::nan("");
  stage.tick();
  EXPECT_EQ(length(stage.hand().force_sent), 0.0);
}

// The device is lost during a motion, and back 50 mm away: the tool waits in place, then moves to its device. Only
// there is a force rendered, rising no faster than the device allows.
TEST(ToolFeedback, AToolWhoseDeviceIsLostWaitsAndIsTakenUpAgainWithoutAJump) {
  Handle6 settings = coupling(200.0);
  settings.translation[1] = 2.0;
  settings.max_force = 3.3;
  Stage stage(settings);
  HapticDevice& hand = stage.hand();
  hand.max_force = 3.3;
  hand.max_slew = 20.0;
  stage.model.force[1] = stage.model.linear.force[1] = stage.model.contacts.tissue_force[1] = 0.1;
  double before = 0.0;
  const auto run = [&](int ticks, auto each) {
    for (int i = 0; i < ticks; ++i) {
      if (i % 16 == 0) stage.publish();
      stage.tick();
      each(i);
      const double now = length(hand.force_sent);
      if (now > 0.0) EXPECT_LE(now - before, hand.max_slew * kTick * (1 + 1e-9)) << "tick " << stage.ticks;
      before = now;
    }
  };
  run(100, [&](int) { hand.position.x += 1e-4; });
  EXPECT_GT(before, 0.05);
  EXPECT_GT(linear(stage.state().handle.velocity).x, 0.05);

  hand.status = DeviceStatus::kLost;
  stage.tick();
  const Pose held = stage.state().handle.pose;
  run(200, [&](int i) {
    EXPECT_EQ(length(hand.force_sent) + length(hand.torque_sent), 0.0) << i;
    EXPECT_EQ(stage.state().handle.pose.position, held.position) << i;
    EXPECT_EQ(stage.state().handle.pose.rotation, held.rotation) << i;
    stage.state().input.acquire();
    const ToolInput& told = stage.state().input.read();
    EXPECT_EQ(told.status, DeviceStatus::kLost);
    EXPECT_EQ(told.device.velocity.norm() + told.handle.velocity.norm(), 0.0) << i;
  });

  hand.status = DeviceStatus::kReady;
  hand.position.x += 0.05;
  double most = 0.0;
  int silent = 0;
  run(400, [&](int) {
    const double wanted = length(linear(stage.state().device_wrench));
    most = std::max(most, wanted);
    if (wanted > kEngageForce && length(hand.force_sent) == 0.0) ++silent;
    EXPECT_LE(length(hand.force_sent), 0.25) << "felt before the tool had come";
  });
  EXPECT_GT(most, 3.0) << "the coupling was strained: there was something to be spared";
  EXPECT_GT(silent, 5);
  EXPECT_NEAR(stage.state().handle.pose.position.x, hand.position.x, 1e-4);
  EXPECT_NEAR(length(hand.force_sent), 0.1, 0.01);
}

TEST(ToolFeedback, ACarriedToolIsLetGoWhenItsModelIsTooOldToBeBelieved) {
  for (const ToolForce mode : {ToolForce::kHeld, ToolForce::kLinear, ToolForce::kContacts}) {
    Stage stage(coupling(200.0));
    stage.state().wanted = mode;
    // Tissue pulls down with its weight, the compensation balances it: zero force on the hand.
    stage.model.force[1] = stage.model.linear.force[1] = stage.model.contacts.tissue_force[1] = -0.5;
    stage.model.handle_load[1] = 0.5;
    stage.publish();
    double most = 0.0;
    for (int i = 0; i < 1000; ++i) {  // the soft clock has stopped
      stage.tick();
      most = std::max(most, stage.state().device_wrench.norm());
    }
    EXPECT_LT(most, 0.01) << "by weight or by what carries it";
  }
}

TEST(CondensedState, AStiffContactGoesOnFromItsLastForceUnlessThatIsNoNumber) {
  CondensedContacts model;
  model.resize(4, 2);
  model.count = 1;
  model.stiff[0] = 1, model.key[0] = 7;
  model.prepare_tick(kTick);
  CondensedState state;
  state.resize(4, 2);
  state.start(model);
  state.problem.impulse.head<3>() << 2e-3, 1e-3, 0.0;
  state.start(model);
  EXPECT_EQ(state.problem.impulse[0], 2e-3);
  state.problem.impulse[1] = std::nan("");
  state.start(model);
  EXPECT_EQ(state.problem.impulse.head<3>(), Eigen::Vector3d::Zero());
}

TEST(ToolFeedback, AModelThatIsNoNumberIsNotFeltAndTheNextOneIs) {
  Stage stage(coupling(200.0));
  const auto press = [&](double newton) {
    stage.model.force[1] = stage.model.linear.force[1] = stage.model.contacts.tissue_force[1] = newton;
    stage.publish();
  };
  press(0.1);
  for (int i = 0; i < 40; ++i) stage.tick();
  EXPECT_GT(length(stage.hand().force_sent), 0.05);
  press(std::nan(""));
  for (int i = 0; i < 3; ++i) {
    stage.tick();
    EXPECT_TRUE(std::isfinite(length(stage.hand().force_sent)));
    EXPECT_LE(length(stage.hand().force_sent), 0.11);
  }
  EXPECT_EQ(length(stage.hand().force_sent), 0.0);
  EXPECT_NE(stage.world.dropped & kDroppedNonFinite, 0u);
  EXPECT_TRUE(stage.state().impulse.allFinite()) << "or the soft clock would never hear of a force again";
  press(0.1);
  for (int i = 0; i < 40; ++i) stage.tick();
  EXPECT_NEAR(length(stage.hand().force_sent), 0.1, 0.01);
}

TEST(ToolFeedback, NothingLeavesAtOnceWhereTheDevicesRotationIsNone) {
  Stage stage(coupling(200.0));
  stage.hand().max_slew = 1.0;  // letting go by slewing would take 100 ticks
  stage.model.force[1] = stage.model.linear.force[1] = stage.model.contacts.tissue_force[1] = 0.1;
  for (int i = 0; i < 200; ++i) {
    if (i % 16 == 0) stage.publish();
    stage.tick();
  }
  EXPECT_GT(length(stage.hand().force_sent), 0.05);
  stage.hand().rotation = dquat(0, 0, 0, 0);
  stage.tick();
  EXPECT_EQ(length(stage.hand().force_sent), 0.0);
  EXPECT_EQ(length(stage.hand().torque_sent), 0.0);
}

TEST(ToolFeedback, OnlyRealTimeGivesATickABudgetOfWallTime) {
  Stage stage;
  EXPECT_EQ(stage.state().limits.budget_ns, 0u);
  limit_tool_ticks(stage.world);
  EXPECT_EQ(stage.state().limits.budget_ns, 300000u);
}

TEST(ToolFeedback, ADeviceThatMovesAProbeAlreadyIsRefused) {
  Stage stage;
  const Entity probe = stage.world.registry.create();
  stage.world.registry.add<Probe>(probe, {}).device = stage.device;
  // Names come from files and must not be used as format strings.
  const std::string odd = "a{b}%s%n{}{0}";
  stage.world.registry.add<Name>(probe, {"tip" + odd});
  stage.world.registry.get<Name>(stage.device).value = odd;
  for (auto [entity, handle] : stage.world.registry.view<Handle6>()) handle.device = odd;
  const Status status = prepare_tools(stage.world);
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().what, "its device `" + odd + "` already moves `tip" + odd + "`");
  EXPECT_EQ(status.error().cure, "give each its own");
}

}  // namespace
}  // namespace pliant
