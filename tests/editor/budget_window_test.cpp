// The panel of error budgets, operated in an invisible window.
#include "content/level_file.h"
#include "scenes/scenes.h"
#include "tests/editor/shell_window.h"

namespace pliant::testing {
namespace {

class BudgetWindowTest : public EditorWindow {
 protected:
  void SetUp() override {
    EditorWindow::SetUp();
    Level level = sheet_and_finger();
    level.nodes[0].deformable->reach = 0.03;
    level.meshes.push_back({"slab", {scenes::slab(6, 0.1, 0.05)}});
    LevelNode slab;
    slab.name = "slab";
    slab.mesh = 1;
    slab.soft_body.emplace();
    slab.soft_body->young = 1e4;
    slab.soft_body->rayleigh = {0.0, 0.01};
    slab.soft_body->error = 0.8;
    slab.local.translation.y = -0.2f;
    level.nodes.push_back(slab);
    for (const char* name : {"small.glb", "other.glb"}) ASSERT_TRUE(save_level(level, folder / name).ok());
  }
  Said edited(const std::string& script) const { return edit("small.glb", script); }
  Level saved() const {
    Result<Level> level = load_level(folder / "small.glb");
    EXPECT_TRUE(level.ok()) << level.error().message();
    return level ? *std::move(level) : Level();
  }
};

TEST_F(BudgetWindowTest, ASurfaceIsMeasuredForATypedBudgetAndWhatItChoosesIsUsedAndUndone) {
  const Said said = edited(R"(
click Tab/Error budget
expect-no Error budget/Measure
click Scene/sheet/row
expect-no Error budget/No budget
set Error budget/error 0.4
click Error budget/Measure
await Error budget/Use it
expect Candidates/shape wendland, distance chord, reach 30 mm
expect Points/shape wendland, distance chord, reach 30 mm
move Points/shape wendland, distance chord, reach 30 mm
screenshot measured.png
click Error budget/Give it this budget
click Error budget/Use it
expect Error budget/Let the budget choose
expect Error budget/No budget
key Ctrl+Z
expect Error budget/Use it
key Ctrl+Shift+Z
key Ctrl+S
say Saved
close
)");
  ASSERT_EQ(said.status, 0) << said.err;
  const Level level = saved();
  ASSERT_TRUE(level.nodes[0].deformable);
  EXPECT_EQ(level.nodes[0].deformable->error, 0.4);
  EXPECT_TRUE(level.nodes[0].stated.contains("deformable.shape"));
  EXPECT_TRUE(level.nodes[0].stated.contains("deformable.distance"));
  // `pliant inspect --fit` of the file reports the applied choice, and nothing else is left to choose.
  const Said fit = pliant({"inspect", "small.glb", "--fit", "--json"});
  ASSERT_EQ(fit.status, 0) << fit.err;
  EXPECT_NE(fit.out.find("the level itself says shape, distance"), std::string::npos) << fit.out;
}

TEST_F(BudgetWindowTest, ABudgetOfTheLevelIsEditedAndAnObjectThatChangedIsMeasuredAgain) {
  const Said said = edited(R"(
click Scene/slab/row
click Tab/Error budget
expect Error budget/No budget
click Error budget/Measure
await Error budget/Measure again 120
set Error budget/error 2
key Ctrl+S
set Inspector/soft_body/poisson 0.3
screenshot stale.png
click Error budget/Measure again
await Error budget/Use it 120
click Error budget/Use it
expect Error budget/Let the budget choose
key Ctrl+S
say Saved
close
)");
  ASSERT_EQ(said.status, 0) << said.err;
  const Level level = saved();
  EXPECT_EQ(level.nodes[2].soft_body->error, 2.0);
  EXPECT_EQ(level.nodes[2].soft_body->poisson, 0.3);
  EXPECT_GT(level.nodes[2].soft_body->cell, 0.0);
  EXPECT_TRUE(level.stated.contains("simulation.soft_step"));
}

TEST_F(BudgetWindowTest, NothingHappensWhereTheObjectOrTheDocumentGoesWhileItIsMeasured) {
  const Said said = edited(R"(
click Tab/Error budget
click Scene/slab/row
click Error budget/Measure
click Error budget/Cancel
expect Error budget/Measure
click Error budget/Measure
key Delete
expect-no Scene/slab/row
key Ctrl+Z
click Scene/slab/row
expect Error budget/Measure
click Error budget/Measure
click Scene/sheet/row
expect Error budget/Cancel
drop other.glb
await Question/Open
click Question/Open
await Scene/slab/row
click Scene/slab/row
expect Error budget/Measure
click Error budget/Measure
click Tab/Console
key Ctrl+N
wait 0.2
close
)");
  EXPECT_EQ(said.status, 0) << said.err;
}

}  // namespace
}  // namespace pliant::testing
