// Effects in the editor: added, changed by the key table, drawn where they act.
#include <gtest/gtest.h>

#include "editor/app/add.h"
#include "editor/app/editor.h"
#include "editor/document/edits.h"
#include "editor/viewport/frames.h"
#include "editor/viewport/signs.h"

namespace pliant {
namespace {

std::vector<ViewSign> signs_of(const State& state) {
  SolidOrder order;
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
