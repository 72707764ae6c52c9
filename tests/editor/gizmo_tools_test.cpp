// The tools that move, turn and scale, as the viewport drives them.
#include <thread>

#include "editor/core/settings.h"
#include "editor/tools/tools.h"
#include "tests/editor/gizmo_fixture.h"

namespace pliant::test {
namespace {

struct Hand {
  Tree tree;
  Settings settings;
  std::unique_ptr<ViewTool> tool;
  ViewportInput in;
  Hand() {
    in.view = {.eye = {0, 0, 1}, .target = {0, 0, 0}};
    in.width = 1280;
    in.height = 720;
    in.over = true;
  }
  NodeId take_ball() {
    const NodeId id = tree.add("ball", {});
    tree.editor.selected = {id};
    return id;
  }
  dvec2 at(dvec3 place) const { return pixel(GizmoPicture{in.view, 0.0, in.width, in.height}, place); }
  bool to(dvec2 place) {
    in.dx = place.x - in.x;
    in.dy = place.y - in.y;
    in.x = place.x;
    in.y = place.y;
    return tool->use(tree.editor, in);
  }
  bool press(dvec2 place) {
    in.x = place.x;
    in.y = place.y;
    in.dx = in.dy = 0;
    in.pressed = in.held = true;
    const bool taken = tool->use(tree.editor, in);
    in.pressed = false;
    return taken;
  }
  void let_go() {
    in.held = false;
    in.released = true;
    in.dx = in.dy = 0;
    tool->use(tree.editor, in);
    in.released = false;
  }
  void type(const std::string& text) {
    in.dx = in.dy = 0;
    for (const char c : text) {
      in.typed = std::string(1, c);
      tool->use(tree.editor, in);
    }
    in.typed.clear();
  }
  void enter() {
    in.enter = true;
    tool->use(tree.editor, in);
    in.enter = false;
  }
};

TEST(Gizmo, ADragIsShownAtOnceAndIsOneStepToUndo) {
  Hand hand;
  const NodeId id = hand.take_ball();
  hand.tool = make_move_tool(hand.settings);
  const std::size_t steps = hand.tree.editor.document.step_count();
  const double size = *metres_of_pixel({hand.in.view, 0.0, 1280, 720}, {0, 0, 0});
  const dvec2 grab = hand.at({60 * size, 0, 0});
  ASSERT_TRUE(hand.press(grab));
  for (int i = 1; i <= 10; ++i) {
    ASSERT_TRUE(hand.to(grab + dvec2(10.0 * i, 3.0)));
    // The place on the axis that is nearest to the mouse's ray, which passes above it at a slope of b.
    const double b = 3.0 * size / length(hand.in.view.eye - hand.in.view.target);
    EXPECT_NEAR(hand.tree.place(id).x, (60.0 + 10.0 * i) * size / (1.0 + b * b) - 60.0 * size, 1e-7)
        << "the mouse is beside the axis";
    EXPECT_NEAR(hand.tree.place(id).y, 0.0, 1e-9) << "it keeps to its axis";
  }
  hand.let_go();
  EXPECT_EQ(hand.tree.editor.document.step_count(), steps + 1);
  hand.tree.editor.undo();
  EXPECT_EQ(hand.tree.place(id), dvec3(0));
}

TEST(Gizmo, SnappingIsTurnedRoundByControl) {
  for (const bool control : {false, true}) {
    Hand hand;
    const NodeId id = hand.take_ball();
    hand.settings.snap = true;
    hand.settings.snap_move = 0.05;
    hand.tool = make_move_tool(hand.settings);
    const double size = *metres_of_pixel({hand.in.view, 0.0, 1280, 720}, {0, 0, 0});
    ASSERT_TRUE(hand.press(hand.at({60 * size, 0, 0})));
    hand.in.control = control;
    hand.to(hand.at({60 * size + 0.12, 0, 0}));
    EXPECT_NEAR(hand.tree.place(id).x, control ? 0.12 : 0.10, 1e-6);
    hand.let_go();
  }
}

TEST(Gizmo, EscapeLeavesNodesAndUndoAsTheyWere) {
  Hand hand;
  const NodeId id = hand.take_ball();
  hand.tool = make_turn_tool(hand.settings);
  const std::size_t steps = hand.tree.editor.document.step_count();
  hand.type("z45");
  EXPECT_NEAR(glm::degrees(glm::angle(hand.tree.editor.state().find(id)->node.local.rotation)), 45.0, 1e-3);
  hand.in.escape = true;
  hand.tool->use(hand.tree.editor, hand.in);
  EXPECT_EQ(hand.tree.editor.document.step_count(), steps);
  EXPECT_EQ(hand.tree.editor.state().find(id)->node.local.rotation, quat(1, 0, 0, 0));
  EXPECT_FALSE(hand.tool->wants_keys());
}

TEST(Gizmo, ATypedMoveTakesEffectWhileItIsTypedAndEnterKeepsIt) {
  Hand hand;
  const NodeId id = hand.take_ball();
  hand.tool = make_move_tool(hand.settings);
  hand.type("x 5mm");
  EXPECT_TRUE(hand.tool->wants_keys()) << "digits are no standard views now";
  EXPECT_NEAR(hand.tree.place(id).x, 0.005, 1e-9);
  hand.type("y");
  EXPECT_NEAR(hand.tree.place(id).x, 0.0, 1e-9);
  EXPECT_NEAR(hand.tree.place(id).y, 0.005, 1e-9);
  hand.enter();
  EXPECT_FALSE(hand.tool->wants_keys());
  hand.tree.editor.undo();
  EXPECT_EQ(hand.tree.place(id), dvec3(0)) << "all of it is one step";
}

TEST(Gizmo, APressBesideTheHandlesIsLeftToTheView) {
  Hand hand;
  hand.tree.editor.selected = {hand.tree.add("ball", {})};
  for (auto make : {make_move_tool, make_turn_tool, make_scale_tool}) {
    hand.tool = make(hand.settings);
    EXPECT_FALSE(hand.press({30, 30}));
    hand.in.held = false;
  }
}

TEST(Gizmo, WithShiftTheLowestPointFollowsTheSurfaceUnderTheMouse) {
  Hand hand;
  Editor& editor = hand.tree.editor;
  State state = editor.state();
  LevelMesh plate;
  plate.name = "plate";
  plate.primitives.emplace_back();
  plate.primitives[0].position = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  plate.primitives[0].index = {0, 2, 1, 0, 3, 2};
  state.meshes.push_back(std::make_shared<const DocumentMesh>(plate));
  LevelNode node;
  node.name = "plate";
  node.mesh = 0;
  ASSERT_TRUE(editor.apply("Add", with_node(state, editor.document.new_id(), kNoNode, node)));
  const NodeId ball = hand.tree.add("ball", {.translation = {0, 0.3f, 0}});
  editor.selected = {ball};
  hand.in.view = {.eye = {0.2, 1.0, 1.5}, .target = {0, 0, 0}};
  hand.tool = make_move_tool(hand.settings);
  ASSERT_TRUE(hand.press(hand.at({0, 0.3, 0})));
  hand.in.shift = true;
  const dvec3 wanted(0.4, 0, -0.2);
  for (int n = 0; n < 400 && length(hand.tree.place(ball) - wanted) > 1e-3; ++n) {
    hand.to(hand.at(wanted) + dvec2(0, n % 2 ? 0.0 : 1e-6));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    editor.jobs.deliver(editor);
  }
  EXPECT_LT(length(hand.tree.place(ball) - wanted), 1e-4);
  hand.let_go();
}

}  // namespace
}  // namespace pliant::test
