// Playing with the mouse: which probe or tool it moves.
#include <gmock/gmock.h>

#include "tests/editor/play_fixture.h"

namespace pliant::test {
namespace {

TEST_F(PlayTest, OfTwoProbesOfTheMouseItMovesTheFirstAndTheOtherIsSaid) {
  State state = pressed_sheet({});
  Level level = level_of(state);
  level.nodes[1].device->driver = DriverKind::kMouse;
  LevelNode second = level.nodes[1];
  second.name = second.probe_device = "second";
  second.local.translation = {0.03f, 0.04f, 0};
  level.nodes.push_back(second);
  NodeId next = 1;
  const auto run = run_of(state_of(std::move(level), next), folder / "level.glb");
  const PlayStatus status = after(*run, 200);
  EXPECT_THAT(status.notes, ::testing::Contains(::testing::HasSubstr("the mouse moves `tip`; nothing moves `second`")));
  ASSERT_EQ(status.effectors.size(), 2u);
  EXPECT_TRUE(status.effectors[0].reading.ready);
  EXPECT_FALSE(status.effectors[1].reading.ready);
  EXPECT_GT(length(status.effectors[0].reading.position - status.effectors[1].reading.position), 1e-3);
}

TEST_F(PlayTest, TheMouseGetsAProbeOfItsOwnWhereNothingElseIsMovedByIt) {
  for (const bool level_has_one : {false, true}) {
    State state = pressed_sheet({});
    if (level_has_one) {
      DocumentNode tip = *state.find("tip");
      tip.node.device->driver = DriverKind::kMouse;
      state.nodes.back() = std::make_shared<const DocumentNode>(tip);
    }
    PlayOptions options;
    options.mouse_probe = true;
    const PlayStatus status = run_of(state, folder / "level.glb", options)->status();
    ASSERT_EQ(status.effectors.size(), level_has_one ? 1u : 2u);
    EXPECT_EQ(status.effectors.back().source, "mouse");
  }
}

TEST_F(PlayTest, WhatTheMouseDidIsHadAgainToo) {
  const State state = pressed_sheet(soft_law());
  PlayOptions options;
  options.sources = {{"tip", {PlaySource::Kind::kMouse, {}}}};
  const auto run = run_of(state, folder / "level.glb", options);
  EXPECT_EQ(run->status().effectors[0].source, "mouse");
  after(*run, 50);
  Picked seen;
  seen.object = Entity();
  seen.rest = seen.point = {0.01, 0, 0.01};
  const ViewRay down{{0.01, 1, 0.01}, {0, -1, 0}};
  // The sheet is the first deformable object: its entity is what picking would return.
  const auto spawned = spawn(level_of(state));
  ASSERT_TRUE(spawned);
  seen.object = find_by_name(*spawned, "sheet");
  run->hand.see(seen, down);
  EXPECT_EQ(run->hand.over(), PlayHand::Over::kTouchable);
  after(*run, 400);
  EXPECT_FALSE(run->status().effectors[0].reading.touching) << "it hovers until it is pressed";
  Picked far = seen;  // a late picture: the mouse is 8 cm away meanwhile
  far.rest = far.point = {-0.045, 0, -0.045};
  run->hand.see(far, {{-0.045, 1, -0.045}, {0, -1, 0}});
  after(*run, 300);
  run->hand.see(seen, down);
  const PlayStatus back = after(*run, 300);
  EXPECT_THAT(back.findings, ::testing::IsEmpty()) << back.findings.front();
  EXPECT_NEAR(back.effectors[0].reading.position.x, 0.01, 1e-4);
  run->hand.hold(true);
  const PlayStatus pressed = after(*run, 1500);
  EXPECT_NEAR(pressed.effectors[0].reading.depth, run->hand.depth_goal(), 0.02 * run->hand.depth_goal());
  EXPECT_GT(pressed.effectors[0].reading.force.y, 0.1);
  run->hand.wheel(3, {});
  const PlayStatus deeper = after(*run, 1500);
  EXPECT_GT(deeper.effectors[0].reading.depth, 1.5 * pressed.effectors[0].reading.depth);
  run->hand.hold(false);
  EXPECT_FALSE(after(*run, 500).effectors[0].reading.touching);

  PlayOptions again = options;
  again.past = run->past();
  again.until = deeper.tick;
  EXPECT_EQ(run_of(state, folder / "level.glb", again)->status().hash, deeper.hash);
}

TEST_F(PlayTest, AToolIsLedByItsScriptUntilTheMouseTakesHoldOfIt) {
  const fs::path file = bring("instrument.glb");
  auto document = Document::open(file);
  ASSERT_TRUE(document) << document.error().message();
  PlayOptions options;
  options.mouse_probe = true;
  const auto run = run_of(document->state(), file, options);
  const PlayStatus led = after(*run, 20);
  std::size_t tool = 0;
  while (tool < led.effectors.size() && !led.effectors[tool].tool) ++tool;
  ASSERT_LT(tool, led.effectors.size());
  for (const PlayEffector& each : led.effectors) EXPECT_NE(each.source, "mouse") << each.name;
  const auto spawned = spawn(level_of(document->state()));
  ASSERT_TRUE(spawned);
  Picked seen;
  seen.object = find_by_name(*spawned, led.effectors[tool].name);
  seen.point = seen.rest = led.effectors[tool].reading.position;
  const Viewpoint view{seen.point + dvec3(0, 0, 1), seen.point};
  run->hand.see(seen, {view.eye, {0, 0, -1}});
  ASSERT_EQ(run->hand.over(), PlayHand::Over::kTool);
  run->hand.hold(true);
  EXPECT_EQ(after(*run, 5).effectors[tool].source, "mouse");
  run->hand.follow({view.eye, normalize(dvec3(0.01, 0, -1))}, view);
  EXPECT_NEAR(after(*run, 100).effectors[tool].reading.position.x, seen.point.x + 0.01, 1e-3);
}

}  // namespace
}  // namespace pliant::test
