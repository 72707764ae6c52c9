// Painting by tool and panel, without a window: the effect on the document.
#include "editor/core/painting.h"

#include <thread>

#include "editor/core/editor.h"
#include "editor/tools/paint_legend.h"
#include "plot/heat.h"
#include "tests/content/mesh_shapes.h"

namespace pliant::test {
namespace {

class PaintingTest : public ::testing::Test {
 protected:
  // A ball of radius 1 m about the origin, shared by two nodes; the second is placed beside the first.
  void open(Editor& editor, Primitive primitive = icosphere(4)) const {
    Level level;
    level.meshes.push_back({"ball", {std::move(primitive)}});
    for (const char* name : {"ball", "other"}) {
      LevelNode node;
      node.name = name;
      node.mesh = 0;
      if (level.nodes.empty()) node.deformable = Deformable{};
      if (!level.nodes.empty()) node.local.translation = vec3(5, 0, 0);
      level.nodes.push_back(node);
    }
    NodeId next = editor.document.next_id();
    ASSERT_TRUE(editor.apply("Ball", state_of(std::move(level), next)));
    editor.document.next_id() = next;
    editor.select(editor.state().nodes[0]->id);
    editor.painting->brush.radius = 0.4;
    wait_for_surface(editor);
  }
  static void wait_for_surface(Editor& editor) {
    while (!editor.painting->surface() && editor.painting->preparing()) rest(editor);
    ASSERT_TRUE(editor.painting->surface());
  }
  static void rest(Editor& editor) {
    editor.jobs.deliver(editor);
    editor.painting->update();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  static void settle(Editor& editor) {
    do rest(editor);
    while (!editor.jobs.none() || editor.painting->working());
    rest(editor);
  }
  // From in front at the ball: x and y of the place, up to the silhouette.
  static ViewRay at(double x, double y) { return {{x, y, 5}, {0, 0, -1}}; }
  static void stroke(Editor& editor, BrushMode mode = BrushMode::kSet, bool look_always = true) {
    editor.painting->press(at(-0.5, 0), 1.0, mode);
    for (int i = 1; i <= 20; ++i) {
      editor.painting->move(at(-0.5 + 0.05 * i, 0.02 * i), 1.0);
      if (look_always) settle(editor);
    }
    editor.painting->release();
    settle(editor);
    EXPECT_FALSE(editor.painting->stroking());
  }
  static float most(const Editor& editor, std::uint32_t mesh = 0) {
    const auto it = editor.state().paint.find({mesh, 0, Channel::kStiffness});
    if (it == editor.state().paint.end()) return 1.0f;
    const std::vector<float> values = it->second.flatten();
    return *std::max_element(values.begin(), values.end());
  }
};

TEST_F(PaintingTest, AStrokeIsOneStepOfUndoHoweverManyFramesItTook) {
  Editor editor;
  open(editor);
  const State before = editor.state();
  const std::size_t steps = editor.document.step_count();
  stroke(editor);
  EXPECT_EQ(editor.document.step_count(), steps + 1);
  EXPECT_EQ(editor.document.undo_what(), "Paint stiffness");
  EXPECT_NEAR(most(editor), 2.0f, 0.02f);
  const State after = editor.state();
  stroke(editor, BrushMode::kErase);
  EXPECT_EQ(editor.document.step_count(), steps + 2) << "the next stroke is a step of its own";
  EXPECT_EQ(editor.document.undo_what(), "Erase stiffness");
  editor.undo();
  EXPECT_TRUE(same(editor.state(), after));
  editor.undo();
  EXPECT_TRUE(same(editor.state(), before));
  editor.redo();
  EXPECT_TRUE(same(editor.state(), after));
}

TEST_F(PaintingTest, WhatAStrokeLeavesDoesNotDependOnHowOftenTheInterfaceLooks) {
  Editor often, once;
  open(often);
  open(once);
  for (Editor* editor : {&often, &once}) stroke(*editor, BrushMode::kAdd, editor == &often);
  const LayerKey key{0, 0, Channel::kStiffness};
  ASSERT_TRUE(often.state().paint.contains(key));
  EXPECT_GT(most(often), 1.2f);
  EXPECT_EQ(often.state().paint.at(key), once.state().paint.at(key));
}

TEST_F(PaintingTest, AStrokeThatTheHandGivesUpLeavesTheLevelAsItWas) {
  Editor editor;
  open(editor);
  const State before = editor.state();
  editor.painting->press(at(0, 0), 1.0, BrushMode::kSet);
  settle(editor);
  ASSERT_NEAR(most(editor), 2.0f, 0.1f) << "it is seen while it is painted";
  editor.painting->give_up();
  EXPECT_FALSE(editor.painting->stroking());
  EXPECT_TRUE(same(editor.state(), before));
}

TEST_F(PaintingTest, AnUndoWhileTheHandPaintsEndsTheStroke) {
  Editor editor;
  open(editor);
  const State before = editor.state();
  editor.painting->press(at(0, 0), 1.0, BrushMode::kSet);
  settle(editor);
  editor.undo();
  editor.painting->move(at(0.5, 0), 1.0);
  settle(editor);
  EXPECT_FALSE(editor.painting->stroking());
  EXPECT_TRUE(same(editor.state(), before));
}

TEST_F(PaintingTest, AnotherEditWhileTheHandPaintsIsKeptAndSoIsTheStroke) {
  Editor editor;
  open(editor);
  editor.painting->press(at(0, 0), 1.0, BrushMode::kSet);
  settle(editor);
  ASSERT_TRUE(editor.apply("Rename", renamed(editor.state(), editor.active(), "liver")));
  editor.painting->move(at(0.6, 0), 1.0);
  editor.painting->release();
  settle(editor);
  EXPECT_EQ(editor.active_node()->node.name, "liver");
  EXPECT_NEAR(editor.painting->value_at(*editor.painting->surface(),
                                        editor.painting->under(*editor.painting->surface(), at(0.55, 0))),
              2.0, 0.1);
}

TEST_F(PaintingTest, ANodeThatIsMovedAndScaledIsPaintedWhereTheRayMeetsIt) {
  Editor editor;
  open(editor);
  LocalTransform local = editor.active_node()->node.local;
  local.translation = vec3(0, 10, 0);
  local.scale = vec3(2);
  ASSERT_TRUE(editor.apply("Move", placed(editor.state(), editor.active(), local)));
  wait_for_surface(editor);
  EXPECT_FALSE(editor.painting->under(*editor.painting->surface(), at(0, 0)).valid());
  const SurfaceHit hit = editor.painting->under(*editor.painting->surface(), at(0, 10));
  ASSERT_TRUE(hit.valid());
  EXPECT_NEAR(length(hit.point + editor.painting->corner() - dvec3(0, 10, 2)), 0.0, 0.02);
}

TEST_F(PaintingTest, AClipPlaneLetsTheHandPaintWhatItShows) {
  Editor editor;
  open(editor);
  const auto surface = editor.painting->surface();
  EXPECT_GT(editor.painting->under(*surface, at(0, 0)).point.z, 0.9);
  editor.view.clip = {true, 2, 0.5, false};  // the near part is cut away
  const SurfaceHit inside = editor.painting->under(*surface, at(0, 0));
  ASSERT_TRUE(inside.valid());
  EXPECT_LT(inside.point.z, -0.9);
  editor.view.clip.flipped = true;  // and now the far part
  EXPECT_GT(editor.painting->under(*surface, at(0, 0)).point.z, 0.9);
}

TEST_F(PaintingTest, FillsAndGradientsAreOneStepEachAndReachEveryVertex) {
  Editor editor;
  open(editor);
  Painting& painting = *editor.painting;
  const std::size_t steps = editor.document.step_count();
  painting.values[0] = 3.0;
  painting.fill_all();
  settle(editor);
  ASSERT_EQ(editor.document.step_count(), steps + 1);
  for (const float value : editor.state().paint.at({0, 0, Channel::kStiffness}).flatten()) ASSERT_EQ(value, 3.0f);
  painting.gradient_from = 1.0;
  painting.gradient_to = 5.0;
  const auto surface = painting.surface();
  painting.gradient(painting.under(*surface, at(-0.9, 0)), painting.under(*surface, at(0.9, 0)));
  settle(editor);
  ASSERT_EQ(editor.document.step_count(), steps + 2);
  EXPECT_NEAR(painting.value_at(*surface, painting.under(*surface, at(0, 0))), 3.0, 0.1);
  EXPECT_EQ(painting.painted_range(), (std::pair{1.0, 5.0}));
  painting.clear();
  EXPECT_TRUE(editor.state().paint.empty());
  EXPECT_EQ(editor.document.step_count(), steps + 3);
}

TEST_F(PaintingTest, AFillIsWithheldWherePaintHasChangedMeanwhile) {
  Editor editor;
  open(editor);
  Painting& painting = *editor.painting;
  painting.fill_all();
  ASSERT_TRUE(editor.apply("Paint", with_layer(editor.state(), {0, 0, Channel::kStiffness},
                                               PaintLayer::constant(painting.surface()->vertices_of(0), 7.0f))));
  settle(editor);
  EXPECT_EQ(most(editor), 7.0f);
  EXPECT_NE(editor.said.back().text.find("do it again"), std::string::npos) << editor.said.back().text;
}

TEST_F(PaintingTest, RefiningIsOneStepAndLeavesTheOtherNodesMeshAndThePaintAsTheyWere) {
  Editor editor;
  open(editor, icosphere(2));
  Painting& painting = *editor.painting;
  stroke(editor);
  const float painted = most(editor);
  const State before = editor.state();
  const SurfaceHit hit = painting.under(*painting.surface(), at(0, 0));
  painting.look_whether_coarse(hit, true);
  settle(editor);
  ASSERT_TRUE(painting.pressed && painting.pressed->coarse);
  painting.refine(hit);
  settle(editor);
  const State& after = editor.state();
  ASSERT_EQ(after.meshes.size(), 2u);
  EXPECT_EQ(after.nodes[0]->node.mesh, 1);
  EXPECT_EQ(after.nodes[1]->node.mesh, 0);
  EXPECT_GT(after.meshes[1]->primitives[0].index.size(), after.meshes[0]->primitives[0].index.size());
  EXPECT_EQ(most(editor, 1), painted);
  EXPECT_FALSE(painting.pressed) << "what was too coarse is another mesh now";
  editor.undo();
  EXPECT_TRUE(same(editor.state(), before));
}

TEST_F(PaintingTest, AMeshThatNodesShareIsPaintedOnAllUntilItIsMadeSingle) {
  Editor editor;
  open(editor);
  Painting& painting = *editor.painting;
  EXPECT_EQ(painting.sharing().size(), 2u);
  stroke(editor);
  painting.make_single();
  EXPECT_EQ(painting.sharing().size(), 1u);
  EXPECT_NEAR(most(editor, 1), 2.0f, 0.02f) << "the copy keeps what is painted";
  wait_for_surface(editor);
  painting.values[0] = 9.0;
  stroke(editor);
  EXPECT_NEAR(most(editor, 1), 9.0f, 0.1f);
  EXPECT_NEAR(most(editor, 0), 2.0f, 0.02f) << "the other node's is not touched";
}

TEST_F(PaintingTest, ValuesAreSaidWithWhatBecomesOfThem) {
  Editor editor;
  open(editor);
  Painting& painting = *editor.painting;
  EXPECT_EQ(painting.value_text(2.0), "2 \u00d7 300 N/m = 600 N/m");
  EXPECT_EQ(painting.lacks(), "");
  painting.take_channel(Channel::kPinned);
  EXPECT_EQ(painting.value_text(0.5), "0.5: held");
  EXPECT_EQ(painting.value_text(0.4), "0.4: free");
  EXPECT_NE(painting.lacks().find("soft body"), std::string::npos);
  painting.take_channel(Channel::kFriction);
  editor.select(editor.state().nodes[1]->id);
  EXPECT_EQ(painting.value_text(2.0), "2 \u00d7");
}

TEST_F(PaintingTest, TheRadiusKeepsToWhatIsPaintedOn) {
  Editor editor;
  open(editor);
  Painting& painting = *editor.painting;
  for (int i = 0; i < 200; ++i) painting.scale_radius(1.15);
  EXPECT_NEAR(painting.brush.radius, painting.size(), 0.05 * painting.size());
  for (int i = 0; i < 400; ++i) painting.scale_radius(1 / 1.15);
  EXPECT_NEAR(painting.brush.radius, 1e-3 * painting.size(), 0.1e-3 * painting.size());
  painting.brush.radius = 1e6;
  painting.fit_radius();
  EXPECT_LT(painting.brush.radius, painting.size());
}

TEST(PaintLegendTest, TicksStandWhereTheColoursAre) {
  const std::vector<LegendTick> factors = legend_ticks(false, 0.25, 4.0);
  ASSERT_EQ(factors.size(), 5u);
  EXPECT_DOUBLE_EQ(factors[2].value, 1.0);
  EXPECT_DOUBLE_EQ(factors[2].place, 0.5);
  for (const auto& ticks : {factors, legend_ticks(false, 0.3, 77.0), legend_ticks(true, 0, 0)}) {
    EXPECT_LE(ticks.size(), 9u);
    EXPECT_EQ(ticks.front().place, 0.0);
    EXPECT_EQ(ticks.back().place, 1.0);
    for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_GT(ticks[i].place, ticks[i - 1].place);
  }
}

// Viridis is written twice, in plot/heat.cpp and in editor_solid.frag: dark to light, evenly.
TEST(PaintLegendTest, TheColoursGoFromDarkToLight) {
  double before = -1.0;
  for (int i = 0; i <= 20; ++i) {
    const Color c = heat(i / 20.0);
    const double light = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    EXPECT_GT(light, before);
    before = light;
  }
}

}  // namespace
}  // namespace pliant::test
