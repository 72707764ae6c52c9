// Effects in the editor: added, changed by the key table, drawn where they act.
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "content/author/save_script.h"
#include "content/level_file.h"
#include "editor/app/add.h"
#include "editor/app/guide_lines.h"
#include "editor/core/editor.h"
#include "editor/document/edits.h"
#include "editor/viewport/frames.h"
#include "editor/viewport/signs.h"

namespace pliant {
namespace {

std::vector<ViewSign> signs_of(const State& state, const GuideLines::All& guides = {}) {
  SolidOrder order;
  order.guides = guides;
  order.state = state;
  order.view = {.eye = {0, 0, 1}, .target = {0, 0, 0}};
  order.settings.nodes = true;
  const std::vector<dmat4> frames = world_frames(state);
  std::vector<ViewLine> lines;
  std::vector<ViewSign> signs;
  add_signs(order, frames, std::vector<bool>(frames.size(), true), std::vector<bool>(frames.size(), false), {}, lines,
            signs);
  return signs;
}

double farthest(const ViewSign& sign) {
  double most = 0.0;
  for (const auto& [from, to] : sign.lines)
    most = std::max({most, length(dvec3(from) - sign.place), length(dvec3(to) - sign.place)});
  return most;
}

TEST(EffectEdit, AnAddedEffectIsSelectedAndDrawnWhereItActs) {
  Editor editor;
  add_effect(editor);
  ASSERT_EQ(editor.selected.size(), 1u);
  const NodeId id = editor.selected[0];
  const auto set = [&](const char* key, const Json& value) {
    return editor.apply("Set", with_value(editor.state(), editor.selected, "effect", key, value));
  };
  ASSERT_TRUE(has_component(editor.state(), id, "effect"));
  ASSERT_TRUE(set("range", 0.05));
  std::vector<ViewSign> signs = signs_of(editor.state());
  ASSERT_EQ(signs.size(), 1u);
  EXPECT_NEAR(farthest(signs[0]), 0.05, 1e-6) << "a magnet's range";
  ASSERT_TRUE(set("kind", "forbidden"));
  ASSERT_TRUE(set("radius", 0.07));
  EXPECT_NEAR(farthest(signs_of(editor.state())[0]), 0.07, 1e-6);
  ASSERT_TRUE(set("region", "box"));
  ASSERT_TRUE(set("box", {{"min", {-0.1, 0, 0}}, {"max", {0, 0.2, 0.2}}}));
  EXPECT_NEAR(farthest(signs_of(editor.state())[0]), 0.3, 1e-6);
  EXPECT_EQ(value_of_key(editor.state(), id, "effect", "kind"), "forbidden");
}

// Read from its file, in the node's frame without its scale, whatever the file's length.
TEST(EffectEdit, ARailIsDrawnAlongItsPath) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "pliant_rail";
  std::filesystem::create_directories(folder);
  Path path;
  for (int i = 0; i < 10001; ++i) path.rows.push_back({0.01 * i, {1e-5 * i, 0, 0}, dquat(1, 0, 0, 0)});
  ASSERT_TRUE(save_script(path, "a rail", folder / "rail.csv").ok());
  const std::vector<vec3> points = guide_points(path);
  EXPECT_LE(points.size(), kMostGuideCorners + 1);
  EXPECT_EQ(points.front(), vec3(0));
  EXPECT_EQ(points.back(), vec3(0.1f, 0, 0)) << "its end is not left out";

  LevelNode rail;
  rail.name = "rail";
  rail.effect.emplace().kind = EffectKind::kGuidance;
  rail.effect->path = "rail.csv";
  rail.effect->range = 0.02;
  rail.local.translation = {0, 0.5f, 0};
  rail.local.rotation = glm::angleAxis(glm::radians(90.0f), vec3(0, 1, 0));  // x to -z
  rail.local.scale = vec3(3.0f);
  Level level;
  level.nodes = {rail};
  ASSERT_TRUE(save_level(level, folder / "rail.glb").ok());
  Editor editor;
  Result<Document> document = Document::open(folder / "rail.glb");
  ASSERT_TRUE(document.ok()) << document.error().message();
  editor.take(*std::move(document));
  GuideLines guides;
  guides.update(editor);
  for (int i = 0; i < 5000 && !guides.known().at("rail.csv"); ++i) {
    editor.jobs.deliver(editor);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_TRUE(guides.known().at("rail.csv"));
  const std::vector<ViewSign> signs = signs_of(editor.state(), guides.known());
  ASSERT_EQ(signs.size(), 1u);
  double to_end = 1.0, off_axis = 0.0;
  for (const auto& [from, to] : signs[0].lines) {
    to_end = std::min(to_end, length(dvec3(to) - dvec3(0, 0.5, -0.1)));
    off_axis = std::max(off_axis, length(dvec3(to.x, to.y - 0.5f, 0)));
  }
  EXPECT_LT(to_end, 1e-6);
  EXPECT_NEAR(off_axis, 0.02, 1e-4) << "rings show how far it pulls";
  EXPECT_NEAR(farthest(signs[0]), std::hypot(0.1, 0.02), 1e-4);
}

TEST(EffectEdit, AWrongValueIsRefusedAndChangesNothing) {
  Editor editor;
  add_effect(editor);
  for (const auto& [key, value] : std::initializer_list<std::pair<const char*, Json>>{
           {"kind", "magnet"}, {"stiffness", -1.0}, {"box", 3}, {"peak", "nan"}, {"no_key", 1}}) {
    const Result<State> next = with_value(editor.state(), editor.selected, "effect", key, value);
    ASSERT_FALSE(next.ok()) << key;
    EXPECT_NE(next.error().message().find(key), std::string::npos) << next.error().message();
  }
  const Result<State> without = without_component(editor.state(), editor.selected, "effect");
  ASSERT_TRUE(without.ok());
  EXPECT_FALSE(has_component(*without, editor.selected[0], "effect"));
}

}  // namespace
}  // namespace pliant
