// The tool's touch tick in a separate world: stability against the table of exact limits, smooth updates, aging models,
// missed budgets, no allocations.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/safety/safety.h"
#include "systems/soft/body/rotation_vector.h"
#include "tests/tool/press_scene.h"
#include "tests/tool/touch_stage.h"

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

namespace pliant::test {
namespace {

// [m] how far the device has swung in the last half of three seconds, from 1 mm inside the coupling. The handle is
// against a rigid wall, so that the coupling is all that the device feels; device: exact mass and damper.
double swing(double mass, double damping, double stiffness) {
  TouchStage stage(coupling(stiffness));
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
  TouchStage stage(settings);
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
    TouchStage stage(coupling(200.0));
    stage.state().wanted = mode;
    const auto press = [&](double newton) {
      stage.model.force.setZero();
      stage.press(newton);
    };
    press(0.5);
    stage.publish();
    stage.run(40);
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
      TouchStage stage(coupling(200.0));
      stage.state().wanted = mode;
      stage.model.soft_step = ticks * kTick;
      double due = 0.0;
      for (int i = 0; i < 60; ++i) {
        if (i >= due) {
          const double newton = 0.02 * std::min(i, 50);
          stage.model.force.setZero();
          stage.press(newton);
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
    TouchStage stage(coupling(200.0));
    stage.state().wanted = mode;
    stage.press(1.0);
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
  explicit Pressing(TouchStage& stage, double friction) : scene(firm_tissue(), firm_handle(), friction, 4, 5) {
    at = scene.settle(1.0 / 60.0, 2e-3, 30, kTick, stage.model);
    stage.model.passed_on = stage.model.force;
    stage.hand().position = at.position;
    stage.hand().rotation = at.rotation;
  }
};

TEST(ToolFeedback, LateTicksLeaveTheForceToTheLinearModelWithoutAJump) {
  TouchStage stage(firm_handle());
  Pressing pressing(stage, 0.5);
  ASSERT_GE(stage.model.contacts.count, 30);
  stage.publish();
  stage.run(5);
  EXPECT_EQ(stage.state().used, ToolForce::kContacts);
  const Vector6 before = stage.state().wrench;
  stage.state().limits.budget_ns = 1;
  stage.state().limits.tolerance = 0.0;
  stage.run(kLateTicks);
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
    TouchStage stage(firm_handle());
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

TEST(ToolFeedback, OnlyRealTimeGivesATickABudgetOfWallTime) {
  TouchStage stage;
  EXPECT_EQ(stage.state().limits.budget_ns, 0u);
  limit_tool_ticks(stage.world);
  EXPECT_EQ(stage.state().limits.budget_ns, 300000u);
}

}  // namespace
}  // namespace pliant::test
