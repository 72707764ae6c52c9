// The story of docs/editor.md, with the mouse alone: from an organ's mesh to a saved level with a painted lump, pinned
// tissue, a probe and its path, that `pliant run` plays.
#include "content/level_file.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class StoryWindowTest : public CommandTest {};

TEST_F(StoryWindowTest, AnOrganBecomesALevelThatRuns) {
#ifdef PLIANT_SANITIZED
  GTEST_SKIP() << "pictures of an organ take longer under the sanitizer than a step of the story waits";
#endif
  if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
  const fs::path organ = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid/hra/VH_F_Kidney_L.glb";
  if (!fs::exists(organ)) GTEST_SKIP() << organ << " is missing: the corpus is not beside the repository";
  fs::copy_file(organ, folder / organ.filename());
  const std::string story = (fs::path(PLIANT_SOURCE_DIR) / "docs/editor_story.txt").string();
  const Said said = pliant(
      {"edit", "VH_F_Kidney_L.glb", "--size", "1280x720", "--config", "config", "--out", "shots", "--input", story},
      "ASAN_OPTIONS=detect_leaks=0 XDG_STATE_HOME=state timeout 280 xvfb-run -a -s "
      "'-screen 0 1300x800x24'");
  ASSERT_EQ(said.status, 0) << said.err;

  const Result<Level> level = load_level(folder / "kidney.level.glb");
  ASSERT_TRUE(level.ok()) << level.error().message();
  std::size_t lumps = 0, tissues = 0, probes = 0;
  for (const LevelNode& node : level->nodes) {
    if (node.deformable && node.mesh >= 0)
      for (const Primitive& primitive : level->meshes[static_cast<std::size_t>(node.mesh)].primitives)
        lumps += std::any_of(primitive.stiffness.begin(), primitive.stiffness.end(), [](float f) { return f > 3.5f; });
    tissues += node.soft_body && !node.soft_body->pinned.empty();
    probes += node.probe && node.device && node.device->driver == DriverKind::kScript;
  }
  EXPECT_EQ(lumps, 1u);
  EXPECT_EQ(tissues, 1u);
  EXPECT_EQ(probes, 1u);
  EXPECT_EQ(pliant({"validate", "kidney.level.glb"}).status, 0);
  const Said run = pliant({"run", "kidney.level.glb", "--headless", "--seconds", "1", "--frames", "0", "--out", "out"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("in contact for"), std::string::npos) << run.out;
}

}  // namespace
}  // namespace pliant::testing
