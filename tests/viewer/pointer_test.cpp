// The mouse as a probe, and as a hand that holds a tool: their positions for what the picture shows.
#include "viewer/hand/pointer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "components/soft_body.h"
#include "systems/device/mouse.h"
#include "viewer/hand/mouse_hand.h"

namespace pliant {
namespace {

constexpr double kReach = 0.04;  // [m]
const Viewpoint kAbove{.eye = {0, 1, 0.2}, .target = {0, 0, 0}};
const ViewRay kDown{{0, 1, 0}, {0, -1, 0}};

// A deformable plate of 0.2 m in y = 0, and a rigid table.
struct PointerScene {
  World world;
  Entity plate, table;
  PointerScene() {
    plate = world.registry.create();
    table = world.registry.create();
    DrawMesh draw;
    for (const vec3 p : {vec3(-0.1f, 0, -0.1f), vec3(-0.1f, 0, 0.1f), vec3(0.1f, 0, 0.1f)})
      draw.vertices.push_back({.position = p});
    draw.indices = {0, 1, 2};
    draw.parts = {{0, 3, -1}};
    world.registry.add<Drawable>(plate, {world.draw_meshes.add(std::move(draw))});
    world.registry.add<Deformable>(plate, {{.reach = kReach}});
  }
};

Picked on(Entity object, dvec3 point, dvec3 rest, dvec3 normal = {0, 1, 0}) {
  return {.object = object, .point = point, .rest = rest, .normal = normal};
}

dvec3 settled(Pointer& pointer) {
  pointer.update(10.0);
  return pointer.update(10.0);
}

TEST(Pointer, BeforeAnythingIsSeenTheProbeStandsOutsideOnTheSideOfTheEye) {
  const PointerScene scene;
  Pointer pointer(scene.world, 0.005, kAbove);
  const dvec3 at = pointer.update(0.01);
  EXPECT_GT(at.y, 0.05);
  EXPECT_TRUE(pointer.free());
  EXPECT_FALSE(pointer.over_touchable());
}

TEST(Pointer, HoversOverWhatIsPointedAtAndPressesByStepsOfTheReach) {
  const PointerScene scene;
  constexpr double kRadius = 0.005;
  Pointer pointer(scene.world, kRadius, kAbove);
  pointer.see(on(scene.plate, {0.01, 0, 0}, {0.01, 0, 0}), kDown);
  const double hover = settled(pointer).y - kRadius;
  EXPECT_GT(hover, 0);
  EXPECT_TRUE(pointer.free());
  pointer.hold(true);
  const double first = pointer.depth_goal();
  EXPECT_NEAR(settled(pointer).y, kRadius - first, 1e-9);
  EXPECT_FALSE(pointer.free());
  pointer.deepen(2);
  EXPECT_NEAR(settled(pointer).y, kRadius - first - 2 * 0.05 * kReach, 1e-9);
  pointer.hold(false);
  EXPECT_NEAR(settled(pointer).y, kRadius + hover, 1e-9);
  pointer.stand(1);
  EXPECT_TRUE(pointer.pressing());
  EXPECT_NEAR(settled(pointer).y, kRadius - 0.05 * kReach, 1e-9);
}

TEST(Pointer, ADeepDentUnderTheCursorDoesNotTakeTheProbeDeeper) {
  const PointerScene scene;
  Pointer pointer(scene.world, 0.0, kAbove);
  pointer.hold(true);
  pointer.see(on(scene.plate, {0.01, 0, 0}, {0.01, 0, 0}), kDown);
  const dvec3 flat = settled(pointer);
  for (int picture = 0; picture < 20; ++picture)  // each picture shows the dent of the previous press
    pointer.see(on(scene.plate, settled(pointer), {0.01, 0, 0}), kDown);
  EXPECT_LT(length(settled(pointer) - flat), 1e-12);
}

TEST(Pointer, WhatDoesNotGiveWayIsHoveredOverAndNotPressed) {
  const PointerScene scene;
  Pointer pointer(scene.world, 0.0, kAbove);
  pointer.hold(true);
  pointer.see(on(scene.table, {0.3, -0.1, 0}, {0.3, -0.1, 0}), kDown);
  EXPECT_FALSE(pointer.over_touchable());
  EXPECT_GT(settled(pointer).y, -0.1);
  pointer.see(on(scene.plate, {0, 0, 0}, {0, 0, 0}, {0, -1, 0}), kDown);  // the back of the sheet
  EXPECT_FALSE(pointer.over_touchable());
  EXPECT_GT(settled(pointer).y, 0.0) << "on the far side of what is looked at";
}

TEST(Pointer, WhereNothingIsSeenTheProbeGoesWithTheRayThatSawNothing) {
  const PointerScene scene;
  Pointer pointer(scene.world, 0.0, kAbove);
  pointer.see(on(scene.plate, {0, 0, 0}, {0, 0, 0}), kDown);
  settled(pointer);
  const ViewRay aside{{0, 1, 0}, normalize(dvec3(0.5, -1, 0))};
  pointer.see(std::nullopt, aside);
  const dvec3 at = pointer.update(0.01) - aside.from;
  EXPECT_LT(length(cross(at, aside.along)), 1e-12);
  EXPECT_LT(length(at), 1.0) << "beyond what was pointed at last";
  EXPECT_TRUE(pointer.free());
}

// A movable block and a fixed one.
struct BodyScene : PointerScene {
  Entity block, wall;
  BodyScene() {
    Mesh mesh;
    mesh.box = {vec3(-0.05f), vec3(0.05f)};
    const Handle<Mesh> shape = world.meshes.add(std::move(mesh));
    block = world.registry.create();
    world.registry.add<SoftBody>(block).collision_mesh = shape;
    wall = world.registry.create();
    RigidBody& fixed = world.registry.add<RigidBody>(wall);
    fixed.collision_mesh = shape;
    fixed.fixed = true;
  }
};

TEST(Pointer, PressesABodyFromWhereItStoodWhenThePressBegan) {
  const BodyScene scene;
  Pointer pointer(scene.world, 0.005, kAbove);
  pointer.see(on(scene.block, {0, 0.05, 0}, {0, 0.05, 0}), kDown);
  EXPECT_TRUE(pointer.over_touchable());
  EXPECT_EQ(pointer.holds(), kNoEntity);
  EXPECT_TRUE(pointer.probe_hold().hovers);
  pointer.hold(true);
  EXPECT_EQ(pointer.holds(), scene.block) << "the picture is asked of the body as it was";
  EXPECT_LT(settled(pointer).y, 0.055);
  EXPECT_FALSE(pointer.probe_hold().hovers);
  pointer.hold(false);
  EXPECT_EQ(pointer.holds(), kNoEntity);
}

TEST(Pointer, PullsABodyInThePlaneThatFacesTheEyeUntilItIsLetGo) {
  const BodyScene scene;
  Pointer pointer(scene.world, 0.005, kAbove);
  pointer.see(on(scene.wall, {0, 0.05, 0}, {0, 0.05, 0}), kDown);
  pointer.grab();
  EXPECT_FALSE(pointer.pulls()) << "a wall does not come along";
  pointer.see(on(scene.block, {0, 0.05, 0}, {0, 0.05, 0}), kDown);
  pointer.grab();
  ASSERT_TRUE(pointer.pulls());
  EXPECT_EQ(pointer.probe_hold().body, scene.block);
  EXPECT_FALSE(pointer.free());
  EXPECT_LT(length(pointer.update(0.01) - dvec3(0, 0.05, 0)), 1e-12);
  pointer.follow({{0, 1, 0}, normalize(dvec3(0.1, -1, 0))}, {.eye = {0, 1, 0}, .target = {0, 0, 0}, .up = {0, 0, 1}});
  EXPECT_LT(length(pointer.update(0.01) - dvec3(0.095, 0.05, 0)), 1e-9);
  const std::uint32_t first = pointer.probe_hold().number;
  pointer.hold(false);
  EXPECT_EQ(pointer.probe_hold().body, kNoEntity);
  pointer.grab();
  EXPECT_NE(pointer.probe_hold().number, first);
}

TEST(Pointer, AProbeThatMeetsSurfacesOnlyNeitherPressesNorPullsBodies) {
  const BodyScene scene;
  Pointer pointer(scene.world, 0.005, kAbove, ProbeMeets::kSurfaces);
  pointer.see(on(scene.block, {0, 0.05, 0}, {0, 0.05, 0}), kDown);
  EXPECT_FALSE(pointer.over_touchable());
  EXPECT_FALSE(pointer.over_body());
}

TEST(HeavyCursor, GoesSlowerTheMoreItIsPushedBackAndRejoinsTheHand) {
  HeavyCursor cursor;
  cursor.move_to(100, 50);
  EXPECT_EQ(cursor.x(), 100);
  cursor.move_to(110, 50);
  cursor.update(true, HeavyCursor::kHalfForce, 0.01);
  EXPECT_NEAR(cursor.x(), 105, 1e-12);
  cursor.move_to(120, 50);
  cursor.update(true, 3 * HeavyCursor::kHalfForce, 0.01);
  EXPECT_NEAR(cursor.x(), 107.5, 1e-12);
  for (int i = 0; i < 100; ++i) cursor.update(false, 0, 0.02);
  EXPECT_NEAR(cursor.x(), 120, 1e-6);
}

// A tool at (0.1, 0, 0) whose device is the mouse.
struct ToolScene : PointerScene {
  Entity tool, device;
  ToolScene() {
    tool = world.registry.create();
    device = world.registry.create();
    world.registry.add<Name>(device, {"palm"});
    world.registry.add<HapticDevice>(device, {.driver = DriverKind::kMouse});
    world.registry.add<Handle6>(tool, {.device = "palm"});
    world.registry.add<Pose>(tool, {{0.1, 0, 0}, glm::angleAxis(0.3, dvec3(0, 1, 0))});
  }
};

TEST(Carrier, ExistsOnlyForAToolOnTheMouseAndBeginsWhereTheToolStands) {
  PointerScene none;
  EXPECT_FALSE(Carrier::of(none.world));
  ToolScene scene;
  const std::optional<Carrier> carrier = Carrier::of(scene.world);
  ASSERT_TRUE(carrier);
  EXPECT_EQ(carrier->tool(), scene.tool);
  EXPECT_EQ(carrier->position(), dvec3(0.1, 0, 0));
  EXPECT_EQ(scene.world.registry.get<HapticDevice>(scene.device).rotation, glm::angleAxis(0.3, dvec3(0, 1, 0)));
}

TEST(Carrier, AToolOnAScriptIsTheMousesFromTheFirstHoldOnAndFromWhereItsDeviceIs) {
  ToolScene scene;
  HapticDevice& device = scene.world.registry.get<HapticDevice>(scene.device);
  device.driver = DriverKind::kScript;
  EXPECT_FALSE(Carrier::of(scene.world)) << "nothing leads it";
  device.path = scene.world.paths.add({{{0, {0.1, 0, 0}}, {1, {0.5, 0, 0}}}, false, false});
  std::optional<Carrier> carrier = Carrier::of(scene.world);
  ASSERT_TRUE(carrier);
  EXPECT_EQ(carrier->tool(), scene.tool);
  EXPECT_EQ(carrier->taken(), kNoEntity);
  EXPECT_EQ(device.rotation, dquat(1, 0, 0, 0)) << "its script turns it";
  carrier->grab({0.31, 0, 0}, {0.3, 0, 0});
  EXPECT_EQ(carrier->taken(), scene.device);
  EXPECT_EQ(carrier->position(), dvec3(0.3, 0, 0));
  carrier->update(0.1);
  EXPECT_EQ(carrier->position(), dvec3(0.3, 0, 0));
  carrier->release();
  carrier->grab({0.3, 0, 0}, {0.9, 0, 0});  // the carrier remembers where it left the tool
  EXPECT_EQ(carrier->position(), dvec3(0.3, 0, 0));
}

TEST(Carrier, WhatWasTakenHoldOfStaysUnderTheCursorAtItsDistance) {
  ToolScene scene;
  std::optional<Carrier> carrier = Carrier::of(scene.world);
  ASSERT_TRUE(carrier);
  const Viewpoint view{.eye = {0.2, 0.3, 2}, .target = {0, 0, 0}};
  const dvec3 forward = normalize(view.target - view.eye), grabbed(0.12, 0.02, 0.05);
  const dvec3 before = carrier->position();
  carrier->follow(ray_through(view, 10, 10, 640, 480), view);
  EXPECT_EQ(carrier->position(), before) << "it moves without being held";
  carrier->grab(grabbed, before);
  const ViewRay ray = ray_through(view, 400, 150, 640, 480);
  const auto arrive = [&] {
    for (int i = 0; i < 100; ++i) carrier->update(0.1);
  };
  carrier->follow(ray, view);
  arrive();
  const dvec3 moved = carrier->position() - before, now = grabbed + moved;
  EXPECT_LT(length(cross(now - ray.from, ray.along)), 1e-12);
  EXPECT_NEAR(dot(moved, forward), 0.0, 1e-12);
  carrier->push(2, view);
  arrive();
  const dvec3 pushed = carrier->position() - before - moved;
  EXPECT_GT(dot(pushed, forward), 0.0);
  EXPECT_LT(length(cross(pushed, forward)), 1e-12);
  carrier->release();
  const dvec3 left = carrier->position();
  carrier->follow(ray_through(view, 10, 10, 640, 480), view);
  carrier->update(0.1);
  EXPECT_EQ(carrier->position(), left);
}

TEST(Carrier, AJumpOfThePointerBecomesAGlideThatStopsWhereItIsLetGo) {
  ToolScene scene;
  std::optional<Carrier> carrier = Carrier::of(scene.world);
  ASSERT_TRUE(carrier);
  const Viewpoint view{.eye = {0.1, 0, 1}, .target = {0.1, 0, 0}};
  carrier->grab({0.1, 0, 0}, {0.1, 0, 0});
  const ViewRay right{view.eye, normalize(dvec3(0.25, 0, -1))};  // 0.25 m to the side, in the tool's plane
  carrier->follow(right, view);
  EXPECT_EQ(carrier->position(), dvec3(0.1, 0, 0));
  int turns = 0;
  for (dvec3 before = carrier->position(); carrier->position().x < 0.35 - 1e-9 && turns < 1000; ++turns) {
    carrier->update(0.004);
    EXPECT_LE(length(carrier->position() - before), kFastestCarry * 0.004 * (1 + 1e-9));
    EXPECT_NEAR(carrier->position().y, 0.0, 1e-12);
    EXPECT_NEAR(carrier->position().z, 0.0, 1e-12);
    before = carrier->position();
  }
  EXPECT_EQ(turns, 125);  // 0.25 m at 0.5 m/s
  EXPECT_NEAR(carrier->position().x, 0.35, 1e-9);

  // A hung picture does not permit a jump: the touch clock moves along the path in at most kMouseSlowestFrame.
  carrier->follow({view.eye, normalize(dvec3(-0.25, 0, -1))}, view);
  carrier->update(10.0);
  EXPECT_NEAR(carrier->position().x, 0.35 - kFastestCarry * kMouseSlowestFrame, 1e-9);
  carrier->release();
  carrier->update(1.0);
  EXPECT_NEAR(carrier->position().x, 0.35 - kFastestCarry * kMouseSlowestFrame, 1e-9);
}

// What a press becomes is one decision for every program.
TEST(MouseHand, PressesPullsAndCarriesWhatIsUnderItAndGripsNothingElse) {
  using Grip = MouseHand::Grip;
  using Over = MouseHand::Over;
  const BodyScene scene;
  MouseHand hand;
  EXPECT_FALSE(hand.update(0.01)) << "it moves nothing";
  hand.see(on(scene.plate, {0, 0, 0}, {0, 0, 0}), kDown);
  EXPECT_EQ(hand.press(false, dvec3(0)), Grip::kNone);
  hand.take(Pointer(scene.world, 0.005, kAbove));
  const struct {
    Entity object;
    Over over;
    Grip press, pull;
  } cases[] = {{scene.plate, Over::kTouchable, Grip::kPress, Grip::kPress},
               {scene.block, Over::kBody, Grip::kPress, Grip::kPull},
               {scene.wall, Over::kTouchable, Grip::kPress, Grip::kPress},
               {scene.table, Over::kNothing, Grip::kNone, Grip::kNone}};
  for (const auto& each : cases)
    for (const bool pulls : {false, true}) {
      hand.see(on(each.object, {0, 0.05, 0}, {0, 0.05, 0}), kDown);
      EXPECT_EQ(hand.over(), each.over);
      EXPECT_EQ(hand.press(pulls, dvec3(0)), pulls ? each.pull : each.press);
      EXPECT_EQ(hand.pressing(), hand.grip() == Grip::kPress);
      EXPECT_EQ(hand.probe_hold().body == scene.block, hand.grip() == Grip::kPull);
      hand.release();
      EXPECT_EQ(hand.grip(), Grip::kNone);
      EXPECT_FALSE(hand.pressing());
    }
  hand.see({}, kDown);
  EXPECT_EQ(hand.press(false, dvec3(0)), Grip::kNone);
}

TEST(MouseHand, TheWheelChangesTheDepthOfAPressAndMovesATool) {
  const PointerScene scene;
  MouseHand hand;
  hand.take(Pointer(scene.world, 0.005, kAbove));
  hand.see(on(scene.plate, {0, 0, 0}, {0, 0, 0}), kDown);
  hand.wheel(1, kAbove);
  hand.press(false, dvec3(0));
  const double depth = hand.depth_goal();
  for (const auto& [clicks, steps] : {std::pair(1.0, 1), {2.0, 2}, {0.1, 1}, {-3.0, -3}}) {
    const double before = hand.depth_goal();
    hand.wheel(clicks, kAbove);
    EXPECT_NEAR(hand.depth_goal() - before, steps * 0.05 * kReach, 1e-12) << clicks;
  }
  EXPECT_GT(depth, 0.0);

  ToolScene with_tool;
  hand.take(*Carrier::of(with_tool.world));
  EXPECT_EQ(hand.tool(), with_tool.tool);
  EXPECT_EQ(*hand.update(0.0), dvec3(0.1, 0, 0));
  hand.see(on(with_tool.plate, {0, 0, 0}, {0, 0, 0}), kDown);
  EXPECT_EQ(hand.press(false, dvec3(0)), MouseHand::Grip::kNone);
  hand.see(on(with_tool.tool, {0.1, 0, 0}, {0.1, 0, 0}), kDown);
  EXPECT_EQ(hand.over(), MouseHand::Over::kTool);
  EXPECT_EQ(hand.press(true, dvec3(0)), MouseHand::Grip::kCarry);
  EXPECT_EQ(hand.taken_device(), with_tool.device);
  hand.wheel(1, kAbove);
  EXPECT_LT(hand.update(10.0)->y, 0.0) << "away from the eye";
  hand.let_go();
  EXPECT_EQ(hand.tool(), kNoEntity);
}

}  // namespace
}  // namespace pliant
