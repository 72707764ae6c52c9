// The arithmetic of gizmos: mouse motion in pixels against the resulting node transforms, in metres.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "editor/viewport/frames.h"
#include "editor/viewport/solid_view.h"
#include "tests/editor/gizmo_fixture.h"

namespace pliant::test {
namespace {

class BothProjections : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Gizmo, BothProjections, ::testing::Bool(),
                         [](const auto& p) { return p.param ? "Orthographic" : "Perspective"; });

TEST_P(BothProjections, ADragFromOnePlaceOfAnAxisToAnotherMovesByTheWayBetweenThem) {
  const GizmoPicture picture = seen_from({0.3, 0.2, 0.5}, {0, 0, 0}, GetParam());
  GizmoGrip grip;
  grip.pivot = {0.02, -0.03, 0.05};
  for (int i = 0; i < 3; ++i) {
    const dvec2 from = pixel(picture, grip.pivot + 0.03 * grip.axes[i]),
                to = pixel(picture, grip.pivot + 0.08 * grip.axes[i]);
    const auto by = moved_by(picture, grip, static_cast<GizmoPart>(static_cast<int>(GizmoPart::kX) + i), from, to);
    ASSERT_TRUE(by);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR((*by)[k], k == i ? 0.05 : 0.0, 1e-9);
  }
}

TEST_P(BothProjections, TheSamePixelsMoveAMoleculeAndARoomByTheirOwnMeasure) {
  for (const double size : {1e-6, 1.0, 100.0}) {
    const GizmoPicture picture = seen_from(size * dvec3(0, 0, 2), {0, 0, 0}, GetParam());
    const auto by = moved_by(picture, GizmoGrip{}, GizmoPart::kX, {640, 360}, {740, 360});
    ASSERT_TRUE(by);
    const double metres_a_pixel = 2.0 * 2.0 * size * std::tan(0.35) / 720.0;
    EXPECT_NEAR(by->x, 100 * metres_a_pixel, 1e-6 * size);
    EXPECT_NEAR(*metres_of_pixel(picture, {0, 0, 0}), metres_a_pixel, 1e-6 * metres_a_pixel);
  }
}

TEST_P(BothProjections, APlaneFollowsTheMouseAndKeepsTheThirdAxis) {
  const GizmoPicture picture = seen_from({0.4, 0.3, 0.5}, {0, 0, 0}, GetParam());
  const dvec3 to(0.07, 0, -0.04);
  const auto by = moved_by(picture, GizmoGrip{}, GizmoPart::kZX, pixel(picture, {0, 0, 0}), pixel(picture, to));
  ASSERT_TRUE(by);
  EXPECT_LT(length(*by - to), 1e-9);
}

TEST_P(BothProjections, TheMiddleMovesInThePicturesPlane) {
  const GizmoPicture picture = seen_from({0.4, 0.3, 0.5}, {0, 0, 0}, GetParam());
  const dvec2 from(600, 300), to(710, 260);
  const auto by = moved_by(picture, GizmoGrip{}, GizmoPart::kFree, from, to);
  ASSERT_TRUE(by);
  EXPECT_NEAR(dot(*by, picture.forward()), 0.0, 1e-9);
  const dvec2 way = pixel(picture, *by) - pixel(picture, {0, 0, 0});
  EXPECT_LT(length(way - (to - from)), 1e-6);
}

TEST_P(BothProjections, ARingTurnsByTheAngleBetweenTheTwoPlacesOnIt) {
  const GizmoPicture picture = seen_from({0.3, 0.5, 0.4}, {0, 0, 0}, GetParam());
  const dvec3 axis(0, 1, 0);
  const auto on_ring = [&](double angle) {
    return pixel(picture, {0.1 * std::sin(angle), 0, 0.1 * std::cos(angle)});  // anticlockwise about +y
  };
  EXPECT_NEAR(turned_by(picture, {0, 0, 0}, axis, on_ring(0.2), on_ring(0.9), 84), 0.7, 1e-9);
  EXPECT_NEAR(turned_by(picture, {0, 0, 0}, axis, on_ring(3.0), on_ring(3.3), 84), 0.3, 1e-9) << "over half a turn";
  EXPECT_NEAR(turned_by(picture, {0, 0, 0}, -axis, on_ring(0.2), on_ring(0.9), 84), -0.7, 1e-9);
}

TEST_P(BothProjections, ARingSeenEdgeOnTurnsTheNearSideWithTheHand) {
  const GizmoPicture picture = seen_from({0, 0, 1}, {0, 0, 0}, GetParam());
  // The near side of a rotation about +y moves to the right.
  EXPECT_NEAR(turned_by(picture, {0, 0, 0}, {0, 1, 0}, {640, 360}, {724, 360}, 84), 1.0, 1e-6);
}

TEST_P(BothProjections, ScalingAlongAnAxisFollowsTheHandle) {
  const GizmoPicture picture = seen_from({0.3, 0.2, 0.5}, {0, 0, 0}, GetParam());
  GizmoGrip grip;
  grip.pivot = {0.02, 0, 0};
  const auto by = scaled_by(picture, grip, GizmoPart::kY, pixel(picture, grip.pivot + dvec3(0, 0.05, 0)),
                            pixel(picture, grip.pivot + dvec3(0, 0.12, 0)));
  ASSERT_TRUE(by);
  EXPECT_NEAR(by->x, 1.0, 1e-12);
  EXPECT_NEAR(by->y, 2.4, 1e-6);
}

TEST_P(BothProjections, PictureAndRayAndProjectionAreInversesOfEachOther) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double size : {1e-6, 1.0, 1e3})
    for (int n = 0; n < 200; ++n) {
      const dvec3 target = size * dvec3(unit(random), unit(random), unit(random));
      const dvec3 eye = target + size * (dvec3(0, 0, 2) + dvec3(unit(random), unit(random), unit(random)));
      const GizmoPicture picture = seen_from(eye, target, GetParam());
      const dvec3 place = target + 0.5 * size * dvec3(unit(random), unit(random), unit(random));
      const auto at = picture.pixel(place);
      ASSERT_TRUE(at);
      const ViewRay ray = picture.ray(at->x, at->y);
      EXPECT_LT(length(cross(place - ray.from, ray.along)), 1e-9 * length(place - ray.from)) << "the ray misses it";
      Box box;
      box.add(vec3(target - size));
      box.add(vec3(target + size));
      const glm::dvec4 clip =
          dmat4(clip_from_world(picture.view, picture.orthographic, 1280.0 / 720.0, box)) * glm::dvec4(place, 1.0);
      EXPECT_NEAR(640.0 * (1.0 + clip.x / clip.w), at->x, 0.02);
      EXPECT_NEAR(360.0 * (1.0 - clip.y / clip.w), at->y, 0.02);
      EXPECT_LE(std::abs(clip.z), clip.w) << "between near and far";
    }
}

TEST(Gizmo, SnappingTakesTheNearestMultiple) {
  EXPECT_DOUBLE_EQ(snapped(0.0149, 0.01), 0.01);
  EXPECT_DOUBLE_EQ(snapped(-0.0151, 0.01), -0.02);
  EXPECT_DOUBLE_EQ(snapped(0.0149, 0.0), 0.0149);
}

TEST(Gizmo, AMoveUnderATurnedAndUnevenlyScaledParentIsTheSameMoveInTheWorld) {
  Tree tree;
  const NodeId parent = tree.add("parent", {.translation = {1, 2, 3},
                                            .rotation = glm::angleAxis(0.7f, glm::normalize(vec3(1, 2, 0.5f))),
                                            .scale = {2, 0.5f, 3}});
  const NodeId child = tree.add("child", {.translation = {0.1f, 0.2f, 0.3f}}, parent);
  const NodeId ids[] = {child};
  const dvec3 before = tree.place(child), by(0.05, -0.02, 0.01);
  const GizmoGrip grip = grip_of(tree.editor.state(), ids, child, Pivot::kOrigin, false);
  ASSERT_TRUE(tree.editor.apply("Move", placed(tree.editor.state(), moved(grip, by))));
  EXPECT_LT(length(tree.place(child) - before - by), 1e-6);
}

TEST(Gizmo, LocalAxesAreTheNodesOwnInTheWorld) {
  Tree tree;
  const NodeId parent =
      tree.add("parent", {.rotation = glm::angleAxis(glm::half_pi<float>(), vec3(0, 0, 1)), .scale = vec3(4)});
  const NodeId child = tree.add("child", {.rotation = glm::angleAxis(glm::half_pi<float>(), vec3(0, 1, 0))}, parent);
  const NodeId ids[] = {child};
  const GizmoGrip local = grip_of(tree.editor.state(), ids, child, Pivot::kOrigin, true);
  // x of the child is -z of its parent, which is -z of the world.
  EXPECT_LT(length(local.axes[0] - dvec3(0, 0, -1)), 1e-6);
  EXPECT_LT(length(local.axes[1] - dvec3(-1, 0, 0)), 1e-6);
  const GizmoGrip world = grip_of(tree.editor.state(), ids, child, Pivot::kOrigin, false);
  EXPECT_EQ(world.axes, dmat3(1));
}

TEST(Gizmo, ATurnAboutAWorldAxisIsThatTurnUnderAnyEvenlyScaledParent) {
  Tree tree;
  const NodeId parent = tree.add("parent", {.translation = {1, 0, 0},
                                            .rotation = glm::angleAxis(0.9f, glm::normalize(vec3(1, -1, 2))),
                                            .scale = vec3(2.5f)});
  const NodeId child =
      tree.add("child", {.translation = {0.1f, 0, 0}, .rotation = glm::angleAxis(0.4f, vec3(1, 0, 0))}, parent);
  const NodeId ids[] = {child};
  const dmat4 before = tree.editor.state().to_world(child);
  GizmoGrip grip = grip_of(tree.editor.state(), ids, child, Pivot::kOrigin, false);
  const dmat3 turn = dmat3(glm::rotate(dmat4(1), 0.6, dvec3(0, 1, 0)));
  ASSERT_TRUE(tree.editor.apply("Turn", placed(tree.editor.state(), turned(grip, {0, 1, 0}, 0.6))));
  const dmat4 after = tree.editor.state().to_world(child);
  for (int i = 0; i < 3; ++i) EXPECT_LT(length(dvec3(after[i]) - turn * dvec3(before[i])), 1e-5);
  EXPECT_LT(length(dvec3(after[3]) - dvec3(before[3])), 1e-6);
}

TEST(Gizmo, SeveralNodesTurnAndScaleAboutTheirCommonMiddle) {
  Tree tree;
  const NodeId a = tree.add("a", {.translation = {-0.1f, 0, 0}}), b = tree.add("b", {.translation = {0.3f, 0, 0}});
  const NodeId ids[] = {a, b};
  const GizmoGrip grip = grip_of(tree.editor.state(), ids, b, Pivot::kOrigin, false);
  EXPECT_LT(length(grip.pivot - dvec3(0.1, 0, 0)), 1e-7);
  ASSERT_TRUE(tree.editor.apply("Turn", placed(tree.editor.state(), turned(grip, {0, 0, 1}, glm::half_pi<double>()))));
  EXPECT_LT(length(tree.place(a) - dvec3(0.1, -0.2, 0)), 1e-6);
  EXPECT_LT(length(tree.place(b) - dvec3(0.1, 0.2, 0)), 1e-6);
  tree.editor.undo();
  ASSERT_TRUE(tree.editor.apply("Scale", placed(tree.editor.state(), scaled(grip, dvec3(2)))));
  EXPECT_LT(length(tree.place(a) - dvec3(-0.3, 0, 0)), 1e-6);
  EXPECT_LT(length(tree.place(b) - dvec3(0.5, 0, 0)), 1e-6);
  EXPECT_LT(length(tree.editor.state().find(a)->node.local.scale - vec3(2)), 1e-6f);
}

TEST(Gizmo, ANodeBelowAnotherThatIsHeldGoesWithItOnce) {
  Tree tree;
  const NodeId parent = tree.add("parent", {}), child = tree.add("child", {.translation = {0, 0.1f, 0}}, parent);
  const NodeId ids[] = {child, parent};
  const GizmoGrip grip = grip_of(tree.editor.state(), ids, parent, Pivot::kOrigin, false);
  ASSERT_EQ(grip.held.size(), 1u);
  ASSERT_TRUE(tree.editor.apply("Move", placed(tree.editor.state(), moved(grip, {0.5, 0, 0}))));
  EXPECT_LT(length(tree.place(child) - dvec3(0.5, 0.1, 0)), 1e-6);
}

TEST(Gizmo, ScalingAlongWorldAxesStretchesATurnedNodeThatWay) {
  Tree tree;
  const NodeId id = tree.add("rod", {.rotation = glm::angleAxis(glm::half_pi<float>(), vec3(0, 0, 1))});
  const NodeId ids[] = {id};
  const GizmoGrip grip = grip_of(tree.editor.state(), ids, id, Pivot::kOrigin, false);
  ASSERT_TRUE(tree.editor.apply("Scale", placed(tree.editor.state(), scaled(grip, {1, 3, 1}))));
  // Its own x points along the world's y.
  EXPECT_LT(length(tree.editor.state().find(id)->node.local.scale - vec3(3, 1, 1)), 1e-5f);
}

TEST(Gizmo, AFlatNodeMayBeMovedTurnedAndScaledAndStaysFinite) {
  Tree tree;
  const NodeId parent = tree.add("parent", {}), child = tree.add("child", {.translation = {0.1f, 0, 0}}, parent);
  State state = tree.editor.state();
  auto node = std::make_shared<DocumentNode>(*state.nodes[0]);
  node->node.local.scale = {1, 0, 1};  // as a file may contain
  state.nodes[0] = node;
  const NodeId ids[] = {child};
  for (const bool local : {false, true}) {
    const GizmoGrip grip = grip_of(state, ids, child, Pivot::kMiddle, local);
    for (const auto& all : {moved(grip, {0.1, 0.1, 0.1}), turned(grip, {0, 0, 1}, 0.5), scaled(grip, {2, 2, 2})})
      for (const Placing& each : all)
        for (int i = 0; i < 3; ++i) {
          EXPECT_TRUE(std::isfinite(each.local.translation[i]));
          EXPECT_TRUE(std::isfinite(each.local.scale[i]));
          EXPECT_TRUE(std::isfinite(each.local.rotation[i]));
        }
    EXPECT_NEAR(moved(grip, {0.1, 0, 0}).front().local.translation.x, 0.2, 1e-6);
  }
}

TEST(Gizmo, WhatIsTypedIsAnAxisANumberAndAUnit) {
  EXPECT_EQ(typed_value("x 0.05", "m").axis, GizmoPart::kX);
  EXPECT_DOUBLE_EQ(*typed_value("x 0.05", "m").value, 0.05);
  EXPECT_DOUBLE_EQ(*typed_value("-3mm", "m").value, -3e-3);
  EXPECT_DOUBLE_EQ(*typed_value("z1e-7", "m").value, 1e-7);
  EXPECT_DOUBLE_EQ(*typed_value("+2,5cm", "m").value, 0.025);
  EXPECT_FALSE(typed_value("y -", "m").value);
  EXPECT_TRUE(typed_value("y -", "m").understood);
  EXPECT_FALSE(typed_value("12 parsecs", "m").understood);
  EXPECT_FALSE(typed_value("90mm", "\u00b0").understood) << "an angle is no length";
  EXPECT_FALSE(typed_value("1e999", "m").understood);
}

TEST(Gizmo, LengthsHaveTheUnitOfTheirSize) {
  EXPECT_EQ(metres_text(0.01), "1 cm");
  EXPECT_EQ(metres_text(0.001), "1 mm");
  EXPECT_EQ(metres_text(1e-7), "100 nm");
  EXPECT_EQ(metres_text(-0.25), "-25 cm");
  EXPECT_EQ(metres_text(10), "10 m");
}

TEST(Frames, BelowAndBoundsOfManyNodesAgreeWithTheWalkUpwards) {
  Tree tree;
  std::mt19937 random(3);
  std::vector<NodeId> ids;
  for (int i = 0; i < 120; ++i)
    ids.push_back(tree.add("n", {.translation = {0.01f * static_cast<float>(i), 0, 0}},
                           i % 7 == 0 ? kNoNode : ids[random() % ids.size()]));
  ASSERT_TRUE(tree.editor.apply("Delete", without(tree.editor.state(), std::vector<NodeId>{ids[5], ids[60]})));
  const State& state = tree.editor.state();
  const std::vector<NodeId> some{ids[3], ids[40], ids[90], ids[5]};
  const std::vector<bool> below = at_or_below(state, some);
  const std::vector<dmat4> frames = world_frames(state);
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    const NodeId id = state.nodes[i]->id;
    EXPECT_EQ(state.place(id), i);
    EXPECT_EQ(below[i], std::any_of(some.begin(), some.end(), [&](NodeId s) { return state.below(id, s); }));
    EXPECT_LT(length(dvec3(frames[i][3]) - dvec3(state.to_world(id)[3])), 1e-12);
  }
  EXPECT_EQ(state.find(ids[5]), nullptr);
}

}  // namespace
}  // namespace pliant::test
