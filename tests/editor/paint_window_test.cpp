// The paint tool and panel, operated in an invisible window.
#include "content/level_file.h"
#include "tests/content/mesh_shapes.h"
#include "tests/editor/shell_window.h"

namespace pliant::testing {
namespace {

class PaintWindowTest : public EditorWindow {
 protected:
  // An organ of the corpus, else a ball; with a probe, so that it is a level with a file.
  void write_level() const {
    Level level;
    const fs::path organ = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid/hra/VH_F_Kidney_L.glb";
    if (fs::exists(organ)) {
      auto loaded = load_level(organ);
      ASSERT_TRUE(loaded.ok()) << loaded.error().message();
      level.meshes = loaded->meshes;
      level.meshes.resize(1);  // the capsule
      level.meshes[0].source = -1;
      for (Primitive& primitive : level.meshes[0].primitives) primitive.material = primitive.source = -1;
    } else {
      level.meshes.push_back({"organ", {pliant::test::icosphere(5)}});
    }
    LevelNode node;
    node.name = "organ";
    node.mesh = 0;
    level.nodes.push_back(node);
    LevelNode probe;
    probe.name = "probe";
    probe.probe = Probe{};
    level.nodes.push_back(probe);
    const Status saved = save_level(level, folder / "organ.glb");
    ASSERT_TRUE(saved.ok()) << saved.error().message();
  }
  Said edited(const std::string& script) const { return edit("organ.glb", script); }
};

TEST_F(PaintWindowTest, ALumpIsPaintedUndoneDoneAgainAndSaved) {
  write_level();
  const Said said = edited(R"(
click Scene/organ/row
key Home
key P
await Paint/Fill all
expect Legend
click Paint/Add deformable
expect-no Paint/Add deformable
set Paint/value 4
click Paint/Linear##falloff
drag Viewport@0.48,0.5 to Viewport@0.53,0.48 in 0.3
screenshot painted.png
key Ctrl+Z
say Undone: Paint stiffness
screenshot undone.png
key Ctrl+Shift+Z
say Done again: Paint stiffness
key ]
key Shift+[
click Paint/Pinned
click Paint/Add soft body
drag Viewport@0.5,0.6 to Viewport@0.5,0.62 in 0.2
key Ctrl+S
say Saved organ.glb
close
)");
  ASSERT_EQ(said.status, 0) << said.err;
  const auto level = load_level(folder / "organ.glb");
  ASSERT_TRUE(level.ok()) << level.error().message();
  ASSERT_TRUE(level->nodes[0].deformable);
  EXPECT_TRUE(level->nodes[0].soft_body);
  const Primitive& primitive = level->meshes[0].primitives[0];
  ASSERT_EQ(primitive.stiffness.size(), primitive.position.size());
  const auto count = [](const std::vector<float>& values, float above) {
    return std::count_if(values.begin(), values.end(), [&](float v) { return v > above; });
  };
  EXPECT_GT(count(primitive.stiffness, 2.5f), 3);
  EXPECT_LT(count(primitive.stiffness, 1.0f), static_cast<long>(primitive.stiffness.size() / 4)) << "a lump, not all";
  ASSERT_EQ(primitive.pinned.size(), primitive.position.size());
  EXPECT_GT(count(primitive.pinned, 0.5f), 0);
  EXPECT_NE(read_text(folder / "shots" / "painted.png"), read_text(folder / "shots" / "undone.png"));
}

TEST_F(PaintWindowTest, EveryButtonOfThePaintPanelDoesWhatItSays) {
  write_level();
  const Said said = edited(R"(
click Scene/organ/row
key P
await Paint/Fill all
click Paint/Friction
set Paint/value 3
click Paint/Fill all
await Paint/Fill all
click Paint/Gradient…
click Viewport@0.45,0.5
click Viewport@0.55,0.5
await Paint/Fill all
click Paint/Damping
click Paint/Fill part…
click Viewport@0.5,0.5
await Paint/Fill all
click Paint/Relaxation
click Paint/Fill all
await Paint/Fill all
click Paint/Clear
click Paint/Stiffness
click Paint/Add
click Paint/Smooth
click Paint/Erase
click Paint/Set
click Paint/X##mirror
click Paint/creases
set Paint/radius 5
click Paint/Stop painting
expect-no Legend
click Paint/Start painting
expect Legend
key Ctrl+S
close
)");
  ASSERT_EQ(said.status, 0) << said.err;
  const auto level = load_level(folder / "organ.glb");
  ASSERT_TRUE(level.ok()) << level.error().message();
  const Primitive& primitive = level->meshes[0].primitives[0];
  ASSERT_EQ(primitive.friction.size(), primitive.position.size());
  const auto [least, most] = std::minmax_element(primitive.friction.begin(), primitive.friction.end());
  EXPECT_LT(*least, 1.5f);
  EXPECT_GT(*most, 2.5f);
  EXPECT_EQ(primitive.damping.size(), primitive.position.size());
  EXPECT_TRUE(primitive.relaxation.empty()) << "cleared";
  EXPECT_TRUE(primitive.stiffness.empty());
}

}  // namespace
}  // namespace pliant::testing
