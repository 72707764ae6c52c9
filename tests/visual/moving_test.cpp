// Animated objects are drawn, picked and shadowed at their current pose: the picture equals that of a static world in
// this pose.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "content/level_file.h"
#include "scenes/scenes.h"
#include "systems/schedule.h"
#include "systems/touch/feed/publish.h"
#include "systems/touch/prepare/prepare.h"
#include "systems/visual/renderer.h"
#include "tests/visual/scene.h"

namespace pliant {
namespace {

using test::renderer_for;

constexpr int kMovingWidth = 160, kMovingHeight = 120;
const Viewpoint kMovingAbove{.eye = {0.3, 2.2, 0.4}, .target = {0, 0, 0}, .up = {0, 0, -1}};

int changed_pixels(const Image& a, const Image& b, int than = 0) {
  int count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int most = 0;
    for (std::size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]}));
    count += most > than;
  }
  return count;
}

Snapshot moved(Entity object, const mat4& to_world) {
  Snapshot snapshot;
  snapshot.moved.push_back({object, to_world});
  return snapshot;
}

TEST(Moving, ATurnedSheetIsDrawnAsOneThatStandsThere) {
  NEEDS_A_CONTEXT();
  World world = test::sheet(16);
  const Entity sheet = test::object_of(world);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const Image before = renderer->picture(kMovingAbove, kMovingWidth, kMovingHeight);
  const Pose turned{{0.1, 0.2, -0.1}, glm::angleAxis(0.9, normalize(dvec3(0.2, 1, 0.1)))};
  renderer->update(moved(sheet, turned.matrix()));
  const Image after = renderer->picture(kMovingAbove, kMovingWidth, kMovingHeight);
  world.registry.get<Pose>(sheet) = turned;
  const std::unique_ptr<Renderer> standing = renderer_for(world);
  EXPECT_EQ(changed_pixels(after, standing->picture(kMovingAbove, kMovingWidth, kMovingHeight), 2), 0);
  EXPECT_GT(changed_pixels(after, before), kMovingWidth * kMovingHeight / 20);
}

TEST(Moving, ADentGoesWithTheSheetAndIsPickedThere) {
  NEEDS_A_CONTEXT();
  World world = test::sheet(64);
  const Entity sheet = test::object_of(world);
  const std::unique_ptr<Renderer> renderer = renderer_for(world);
  ASSERT_TRUE(renderer);
  const vec3 center(-0.5f, 0, 0.1f);
  Snapshot snapshot = test::snapshot_of(world, test::dent(center, 0.05f, 0.25f));
  const Pose turned{{0, 0, 0}, glm::angleAxis(0.5 * std::numbers::pi, dvec3(0, 1, 0))};
  snapshot.moved.push_back({sheet, turned.matrix()});
  renderer->update(snapshot);
  // Straight down on the dent's current centre.
  const dvec3 there = turned.to_world(dvec3(center));
  const Viewpoint down{.eye = there + dvec3(0, 2, 0), .target = there, .up = {0, 0, -1}};
  renderer->pick({kMovingWidth / 2.0, kMovingHeight / 2.0, kMovingWidth, kMovingHeight});
  renderer->picture(down, kMovingWidth, kMovingHeight);
  const std::optional<PickAnswer> answer = renderer->picked(true);
  ASSERT_TRUE(answer && answer->seen);
  EXPECT_EQ(answer->seen->object, sheet);
  EXPECT_LT(length(answer->seen->point - (there - dvec3(0, 0.05, 0))), 2e-3);
  EXPECT_LT(length(answer->seen->rest - there), 2e-3);
}

// A sheet, 1 m wide, that rotates about the vertical once in two seconds; `touched`: it is deformable.
Level turning_sheet(bool touched) {
  Level level;
  level.meshes.push_back({"sheet", {scenes::sheet(8, 1.0)}});
  LevelNode node;
  node.name = "sheet";
  node.mesh = 0;
  if (touched) node.deformable.emplace();
  level.nodes.push_back(node);
  LevelChannel turn{0, NodeProperty::kRotation, {}};
  for (int i = 0; i <= 4; ++i) {
    const dquat q = glm::angleAxis(0.5 * std::numbers::pi * i, dvec3(0, 1, 0));
    turn.track.times.push_back(0.5 * i);
    turn.track.values.emplace_back(q.x, q.y, q.z, q.w);
  }
  turn.track.length = 2.0;
  level.animations.push_back({"turn", 2.0, {turn}});
  return level;
}

TEST(Moving, FromTheLevelOverTicksToThePictureWhetherItCanBeTouchedOrNot) {
  NEEDS_A_CONTEXT();
  for (const bool touched : {true, false}) {
    const Level level = turning_sheet(touched);
    Result<World> world = spawn(level);
    ASSERT_TRUE(world.ok()) << world.error().message();
    ASSERT_TRUE(prepare_touch(*world).ok());
    const std::unique_ptr<Renderer> renderer = renderer_for(*world);
    Schedule<World> schedule(touch_schedule());
    Tick tick;
    for (std::uint64_t i = 0; i <= 250; ++i) {
      tick = {i, 1e-3, static_cast<double>(i) * 1e-3};
      schedule.run(*world, tick);
    }
    publish(*world, tick);
    ASSERT_TRUE(world->snapshots->acquire());
    renderer->update(world->snapshots->read());
    const Image seen = renderer->picture(kMovingAbove, kMovingWidth, kMovingHeight);

    Level standing = level;
    standing.animations.clear();
    standing.nodes[0].local.rotation = glm::angleAxis(0.25f * std::numbers::pi_v<float>, vec3(0, 1, 0));
    const Result<World> still = spawn(standing);
    ASSERT_TRUE(still.ok());
    const Image wanted = renderer_for(*still)->picture(kMovingAbove, kMovingWidth, kMovingHeight);
    // Edges may fall on the other side of a sample's middle.
    EXPECT_LT(changed_pixels(seen, wanted, 8), 12) << touched;
  }
}

}  // namespace
}  // namespace pliant
