// The tool's touch tick when something fails: lost devices, models that are too old or no numbers.
#include <cmath>

#include "systems/safety/safety.h"
#include "tests/tool/touch_stage.h"

namespace pliant::test {
namespace {

TEST(ToolFeedback, NothingIsFeltOfADeviceThatIsLost) {
  TouchStage stage(coupling(200.0));
  stage.press(0.1);
  stage.publish();
  stage.run(40);
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
  TouchStage stage(settings);
  HapticDevice& hand = stage.hand();
  hand.max_force = 3.3;
  hand.max_slew = 20.0;
  stage.press(0.1);
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
    const ToolInput& input = stage.state().input.read();
    EXPECT_EQ(input.status, DeviceStatus::kLost);
    EXPECT_EQ(input.device.velocity.norm() + input.handle.velocity.norm(), 0.0) << i;
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
    TouchStage stage(coupling(200.0));
    stage.state().wanted = mode;
    // Tissue pulls down with its weight, the compensation balances it: zero force on the hand.
    stage.press(-0.5);
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
  TouchStage stage(coupling(200.0));
  const auto press = [&](double newton) {
    stage.press(newton);
    stage.publish();
  };
  press(0.1);
  stage.run(40);
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
  stage.run(40);
  EXPECT_NEAR(length(stage.hand().force_sent), 0.1, 0.01);
}

TEST(ToolFeedback, NothingLeavesAtOnceWhereTheDevicesRotationIsNone) {
  TouchStage stage(coupling(200.0));
  stage.hand().max_slew = 1.0;  // letting go by slewing would take 100 ticks
  stage.press(0.1);
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

TEST(ToolFeedback, ADeviceThatMovesAProbeAlreadyIsRefused) {
  TouchStage stage;
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
}  // namespace pliant::test
