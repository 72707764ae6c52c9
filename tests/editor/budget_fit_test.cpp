// Choices of an error budget in the editor: the same candidates as opening the saved file; keys that a second
// measurement keeps; figures marked as stale when the object changes.
#include "editor/budget/budget_fit.h"

#include <gtest/gtest.h>

#include <thread>

#include "content/keys/extension_table.h"
#include "scenes/scenes.h"
#include "tests/editor/small_level.h"

namespace pliant {
namespace {

using testing::id_of;
using testing::OwnFolder;

Level sheet_level(double error) {
  Level level = testing::sheet_and_finger();
  level.nodes[0].deformable->reach = 0.03;
  level.nodes[0].deformable->error = error;
  return level;
}

Level slab_level(double error) {
  Level level;
  level.meshes.push_back({"slab", {scenes::slab(6, 0.1, 0.05)}});
  LevelNode node;
  node.name = "slab";
  node.mesh = 0;
  node.soft_body.emplace();
  node.soft_body->young = 1e4;
  node.soft_body->rayleigh = {0.0, 0.01};
  node.soft_body->error = error;
  level.nodes = {node};
  return level;
}

void take(Editor& editor, const Level& level, const OwnFolder& folder) {
  ASSERT_TRUE(save_level(level, folder.path / "level.glb").ok());
  Result<Document> document = Document::open(folder.path / "level.glb");
  ASSERT_TRUE(document.ok()) << document.error().message();
  editor.take(*std::move(document));
}

void wait_for_fit(Editor& editor) {
  while (!editor.jobs.none()) {
    editor.jobs.deliver(editor);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

BudgetFit fit_now(const Editor& editor, NodeId id, double budget) {
  return fit_budget(editor.state(), id, budget, editor.document.file(), editor.document.folder());
}

void expect_same_candidates(const ModelChoice& a, const ModelChoice& b) {
  ASSERT_EQ(a.tried.size(), b.tried.size());
  for (std::size_t i = 0; i < a.tried.size(); ++i) {
    EXPECT_EQ(a.tried[i].label, b.tried[i].label);
    EXPECT_EQ(a.tried[i].error, b.tried[i].error) << a.tried[i].label;
    EXPECT_EQ(a.tried[i].cost, b.tried[i].cost) << a.tried[i].label;
  }
  EXPECT_EQ(a.chosen, b.chosen);
  EXPECT_EQ(a.sentence(), b.sentence());
}

TEST(BudgetFit, MeasuresTheCandidatesThatOpeningTheSavedFileChoosesFrom) {
  for (const Level& level : {sheet_level(0.4), slab_level(0.8)}) {
    const OwnFolder folder("budget_same");
    Editor editor;
    take(editor, level, folder);
    const NodeId id = id_of(editor.document, level.nodes[0].name);
    // Saved with an edit of the document that the file did not have.
    LocalTransform local = editor.state().find(id)->node.local;
    local.scale = vec3(1.1f);
    ASSERT_TRUE(editor.apply("Larger", placed(editor.state(), id, local)));
    const BudgetFit fit = fit_now(editor, id, budget_of(editor.state().find(id)->node));
    ASSERT_TRUE(fit.choices) << fit.choices.error().message();
    ASSERT_TRUE(editor.document.save());
    Result<Level> saved = load_level(folder.path / "level.glb");
    ASSERT_TRUE(saved.ok());
    const auto choices = choose_models(*saved);
    ASSERT_TRUE(choices) << choices.error().message();
    ASSERT_EQ(choices->size(), 1u);
    EXPECT_GT(fit.choices->front().tried.size(), 3u);
    expect_same_candidates(fit.choices->front(), choices->front());
    // The keys equal those set by opening it.
    ASSERT_GE(fit.keys.size(), 2u);
    ASSERT_TRUE(editor.apply("Use", with_stated(editor.state(), id, fit.keys)));
    for (const StatedKey& each : fit.keys) {
      const Extension& extension = *find_extension(each.extension);
      const void* const owner = extension.on_scene ? static_cast<const void*>(&*saved) : &saved->nodes[0];
      EXPECT_EQ(each.value, find_key(extension, each.key)->get(owner)) << each.key;
      EXPECT_EQ(value_of_key(editor.state(), id, each.extension, each.key), each.value);
    }
  }
}

TEST(BudgetFit, ABudgetThatIsTypedNeedsNoneInTheLevel) {
  const OwnFolder folder("budget_trial");
  Editor editor;
  take(editor, sheet_level(0.0), folder);
  const NodeId id = id_of(editor.document, "sheet");
  const BudgetFit fit = fit_now(editor, id, 0.4);
  ASSERT_TRUE(fit.choices) << fit.choices.error().message();
  EXPECT_EQ(fit.choices->front().budget, 0.4);
  EXPECT_FALSE(editor.document.dirty());
  // Candidates do not depend on the budget: another budget gives the same choice as a separate measurement.
  for (const double budget : {0.9, 0.3, 0.01}) {
    const BudgetFit own = fit_now(editor, id, budget);
    ASSERT_TRUE(own.choices);
    expect_same_candidates(with_budget(fit.choices->front(), budget), own.choices->front());
    EXPECT_EQ(with_budget(fit.choices->front(), budget).within, own.choices->front().within);
  }
}

TEST(BudgetFit, WhatIsUsedIsSavedAndASecondMeasurementKeepsItAndUndoTakesItBack) {
  for (const Level& level : {sheet_level(0.9), sheet_level(0.3), slab_level(0.8)}) {
    const OwnFolder folder("budget_use");
    Editor editor;
    take(editor, level, folder);
    const NodeId id = id_of(editor.document, level.nodes[0].name);
    BudgetFits fits;
    fits.measure(editor, id, level.nodes[0].soft_body ? 0.8 : level.nodes[0].deformable->error);
    EXPECT_TRUE(fits.progress(editor));
    wait_for_fit(editor);
    EXPECT_FALSE(fits.progress(editor));
    ASSERT_TRUE(fits.of(id) && fits.of(id)->choices);
    const ModelChoice first = fits.of(id)->choices->front();
    const State before = editor.state();
    const std::size_t steps = editor.document.step();
    const std::size_t said = stated_keys(before, id).size();  // a reach, of the sheet
    EXPECT_EQ(said, level.nodes[0].soft_body ? 0u : 1u);

    ASSERT_TRUE(fits.use(editor, id));
    EXPECT_EQ(editor.document.step(), steps + 1) << "one step";
    EXPECT_TRUE(fits.in_use(editor.state(), id));
    EXPECT_FALSE(fits.stale(editor.state(), id)) << "the figures are still those of this object";
    EXPECT_EQ(stated_keys(editor.state(), id).size(), said + fits.of(id)->keys.size());

    // In the file, too, where a key that is chosen is at its default.
    ASSERT_TRUE(editor.document.save());
    Result<Document> again = Document::open(folder.path / "level.glb");
    ASSERT_TRUE(again.ok());
    Editor other;
    other.take(*std::move(again));
    const NodeId same_id = id_of(other.document, level.nodes[0].name);
    const BudgetFit second = fit_now(other, same_id, first.budget);
    ASSERT_TRUE(second.choices) << second.choices.error().message();
    ASSERT_EQ(second.choices->front().tried.size(), 1u) << second.choices->front().sentence();
    EXPECT_EQ(second.choices->front().tried[0].label, first.tried[first.chosen].label);
    EXPECT_TRUE(second.keys.empty()) << "the level says them all";

    editor.undo();
    EXPECT_TRUE(same(editor.state(), before));
    EXPECT_EQ(stated_keys(editor.state(), id).size(), said);
    EXPECT_FALSE(fits.in_use(editor.state(), id));
    EXPECT_FALSE(fits.stale(editor.state(), id)) << "it is the object that was measured again";
    editor.redo();
    EXPECT_TRUE(fits.in_use(editor.state(), id));

    // Taken out of the level, the budget chooses as before.
    ASSERT_TRUE(editor.apply("Let the budget choose", without_stated(editor.state(), id, fits.of(id)->keys)));
    EXPECT_TRUE(same(editor.state(), before));
    ASSERT_TRUE(editor.document.save());
    Result<Level> saved = load_level(folder.path / "level.glb");
    ASSERT_TRUE(saved.ok());
    const auto choices = choose_models(*saved);
    ASSERT_TRUE(choices);
    expect_same_candidates(choices->front(), first);
  }
}

TEST(BudgetFit, IsOutOfDateOnceTheObjectOrItsKeysChangeAndNotByItsBudgetOrAnotherObject) {
  const OwnFolder folder("budget_stale");
  Editor editor;
  take(editor, sheet_level(0.4), folder);
  const NodeId id = id_of(editor.document, "sheet"), finger = id_of(editor.document, "finger");
  BudgetFits fits;
  fits.measure(editor, id, 0.4);
  wait_for_fit(editor);
  ASSERT_TRUE(fits.of(id) && fits.of(id)->choices);
  const auto stale_after = [&](const char* what, Result<State> next) {
    const std::size_t step = editor.document.step();
    EXPECT_TRUE(editor.apply(what, std::move(next))) << what;
    EXPECT_EQ(editor.document.step(), step + 1) << what << " changed nothing";
    const bool stale = fits.stale(editor.state(), id);
    const bool used = fits.use(editor, id);
    EXPECT_EQ(used, !stale) << what;
    editor.go_to_step(step);
    EXPECT_FALSE(fits.stale(editor.state(), id)) << what << ", undone";
    return stale;
  };
  const NodeId ids[] = {id};
  const auto s = [&]() -> const State& { return editor.state(); };  // steps move
  EXPECT_TRUE(stale_after("reach", with_value(s(), ids, "deformable", "reach", 0.02)));
  EXPECT_TRUE(stale_after("shape", with_value(s(), ids, "deformable", "shape", "punch")));
  EXPECT_TRUE(stale_after("shape said at its default", with_stated(s(), id, {{"deformable", "shape", "volume"}})));
  EXPECT_TRUE(stale_after("touch rate", with_value(s(), {}, "simulation", "touch_rate", 500.0)));
  LocalTransform local = s().find(id)->node.local;
  local.scale = vec3(2.0f);
  EXPECT_TRUE(stale_after("scale", placed(s(), id, local)));
  LevelMesh mesh = *s().meshes[0];
  mesh.primitives[0].position[30].y += 0.01f;
  EXPECT_TRUE(stale_after("mesh", with_mesh(s(), id, mesh)));
  const std::size_t vertices = s().meshes[0]->primitives[0].position.size();
  EXPECT_TRUE(stale_after("paint", with_layer(s(), {0, 0, Channel::kStiffness}, PaintLayer::constant(vertices, 2.0f))));
  EXPECT_TRUE(stale_after("no surface", without_component(s(), ids, "deformable")));

  EXPECT_FALSE(stale_after("budget", with_value(s(), ids, "deformable", "error", 0.2)));
  EXPECT_FALSE(stale_after("name", renamed(s(), id, "skin")));
  LocalTransform away = s().find(finger)->node.local;
  away.translation.x += 1.0f;
  EXPECT_FALSE(stale_after("finger", placed(s(), finger, away)));
  const NodeId fingers[] = {finger};
  EXPECT_TRUE(stale_after("radius", with_value(s(), fingers, "probe", "radius", 0.003)))
      << "what the truth presses with";
}

TEST(BudgetFit, MeasuringEndsWithTheObjectWithTheDocumentAndWhenItIsCancelled) {
  const OwnFolder folder("budget_end");
  Editor editor;
  take(editor, slab_level(0.8), folder);
  const NodeId id = id_of(editor.document, "slab");
  const NodeId ids[] = {id};
  BudgetFits fits;

  fits.measure(editor, id, 0.8);
  ASSERT_TRUE(editor.apply("Delete", without(editor.state(), ids)));
  fits.update(editor);
  EXPECT_FALSE(fits.progress(editor));
  EXPECT_FALSE(editor.jobs.running(BudgetFits::kJob));
  wait_for_fit(editor);
  EXPECT_FALSE(fits.of(id));
  editor.undo();

  fits.measure(editor, id, 0.8);
  ASSERT_TRUE(editor.apply("Neither", without_component(editor.state(), ids, "soft_body")));
  fits.update(editor);
  EXPECT_FALSE(fits.progress(editor));
  wait_for_fit(editor);
  editor.undo();

  fits.measure(editor, id, 0.8);
  fits.cancel(editor);
  EXPECT_FALSE(fits.progress(editor));
  wait_for_fit(editor);
  EXPECT_FALSE(fits.of(id)) << "what was cancelled has no figures";

  // The result for a document that has been replaced meanwhile.
  fits.measure(editor, id, 0.8);
  take(editor, slab_level(0.5), folder);
  wait_for_fit(editor);
  EXPECT_FALSE(fits.of(id_of(editor.document, "slab")));
  fits.update(editor);
  EXPECT_FALSE(fits.progress(editor));

  // And of the program that ends.
  fits.measure(editor, id, 0.8);
}

TEST(BudgetFit, AnotherDocumentForgetsWhatWasMeasured) {
  const OwnFolder folder("budget_forgets");
  Editor editor;
  take(editor, sheet_level(0.4), folder);
  const NodeId id = id_of(editor.document, "sheet");
  BudgetFits fits;
  fits.measure(editor, id, 0.4);
  wait_for_fit(editor);
  ASSERT_TRUE(fits.of(id));
  take(editor, sheet_level(0.4), folder);
  fits.update(editor);
  EXPECT_FALSE(fits.of(id));
}

TEST(BudgetFit, WhatCannotBePressedSaysSoInTheWordsOfTheChoice) {
  const OwnFolder folder("budget_error");
  Editor editor;
  Level level = slab_level(0.5);
  level.meshes[0].primitives[0] = testing::quad_sheet(6);  // encloses nothing
  take(editor, level, folder);
  const NodeId id = id_of(editor.document, "slab");
  BudgetFits fits;
  fits.measure(editor, id, 0.5);
  wait_for_fit(editor);
  ASSERT_TRUE(fits.of(id));
  Result<Level> saved = load_level(folder.path / "level.glb");
  ASSERT_TRUE(saved.ok());
  const auto choices = choose_models(*saved);
  ASSERT_FALSE(choices);
  ASSERT_FALSE(fits.of(id)->choices);
  EXPECT_EQ(fits.of(id)->choices.error().message(), choices.error().message());
  EXPECT_FALSE(fits.use(editor, id));
}

}  // namespace
}  // namespace pliant
