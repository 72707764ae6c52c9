// The first five minutes, by mouse alone and in at most 25 actions: an organ becomes tissue, is pinned, gets a lump, is
// touched with an instrument or a probe on a path set by clicks, is played and saved; and the file gives the same.
#include <cmath>

#include "content/level/script.h"
#include "content/level_file.h"
#include "editor/document/script_keys.h"
#include "tests/content/mesh_shapes.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class FirstLevelWindowTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
#ifdef PLIANT_SANITIZED
    GTEST_SKIP() << "pictures take longer under the sanitizer than a step of the story waits";
#endif
    if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
  }

  // A ball of the size of an organ, drawn into a form.
  template <class Form>
  void write_organ(const std::string& name, const Form& form) const {
    Level level;
    LevelMesh mesh{name, {pliant::test::icosphere(4)}};
    for (vec3& p : mesh.primitives[0].position) p = vec3(form(normalize(dvec3(p))));
    mesh.primitives[0].normal.clear();
    level.meshes.push_back(std::move(mesh));
    LevelNode node;
    node.name = name;
    node.mesh = 0;
    level.nodes.push_back(node);
    const Status saved = save_level(level, folder / (name + ".glb"));
    ASSERT_TRUE(saved.ok()) << saved.error().message();
  }

  // `kind` of tissue, `tool` of the buttons.
  void tell(const std::string& organ, bool soft, const std::string& tool) const {
    std::string story = "await Inspector/Search\nclick Viewport@0.5,0.5\nclick Tab/Tissue\n";
    story += soft ? "click Tissue/Soft body\nclick Tissue/Material/liver\nwheel Tissue/Material/liver -20\nclick "
                    "Tissue/Pinned/Bottom\n"
                  : "click Tissue/Surface\nclick Tissue/Material/liver\n";
    story += "click Tools/Paint\nwait 1\ndrag Viewport@0.48,0.5 to Viewport@0.52,0.5 in 0.3\n";
    story += "click Tools/Select\nclick Tab/Tissue\nclick Tissue/Instruments/" + tool + "\n";
    story +=
        "click Tab/Path\nclick Path/Set keys\nclick Viewport@0.49,0.49\nclick Viewport@0.53,0.46\nclick Path/Leave\n";
    story += "screenshot keys.png\nclick Play/Play\nawait Play/Pause\nwait 2.5\nscreenshot play.png\nclick Play/Stop\n";
    story += "await Play/Play\nclick Menu/File\nclick Save\nawait Files/Save\nclick Files/Save\nhear Saved\nclose\n";
    std::size_t actions = 0;
    std::istringstream lines(story);
    for (std::string line; std::getline(lines, line);)
      actions += line.starts_with("click") || line.starts_with("drag") || line.starts_with("wheel");
    EXPECT_LE(actions, 25u);
    write_text(folder / "story.txt", story);
    const Said said = pliant(
        {"edit", organ + ".glb", "--size", "1280x720", "--config", "config", "--out", "shots", "--input", "story.txt"},
        "ASAN_OPTIONS=detect_leaks=0 XDG_STATE_HOME=state timeout 200 xvfb-run -a -s "
        "'-screen 0 1300x800x24'");
    ASSERT_EQ(said.status, 0) << organ << ' ' << tool << ": " << said.err;
    const std::string level = organ + ".level.glb";
    EXPECT_EQ(pliant({"validate", level}).status, 0);
    const Said run = pliant({"run", level, "--headless", "--seconds", "6", "--frames", "0", "--out", "out"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto [force, depth] = felt(folder / "out" / "forces.csv");
    EXPECT_GT(force, 0.02) << organ << ' ' << tool << ": nothing is felt\n" << run.out;
    // As deep as the keys, 5 mm; for a tool, depth is the extension of its coupling.
    if (!soft) {
      EXPECT_LT(depth, 0.0052) << organ << ' ' << tool;
      EXPECT_GT(depth, 0.004) << organ << ' ' << tool;
    }
  }

  // [N], [m] The largest of a run.
  static std::pair<double, double> felt(const fs::path& forces) {
    std::ifstream in(forces);
    std::string line;
    std::getline(in, line);
    while (line.starts_with('#')) std::getline(in, line);
    std::vector<std::string> names;
    std::istringstream head(line);
    for (std::string cell; std::getline(head, cell, ',');) names.push_back(cell);
    double force = 0, depth = 0;
    while (std::getline(in, line)) {
      std::istringstream row(line);
      double sum = 0;
      std::size_t i = 0;
      for (std::string cell; std::getline(row, cell, ','); ++i) {
        if (i >= names.size()) break;
        if (names[i] == "fx" || names[i] == "fy" || names[i] == "fz") sum += std::pow(std::atof(cell.c_str()), 2);
        if (names[i] == "depth_m") depth = std::max(depth, std::atof(cell.c_str()));
      }
      force = std::max(force, std::sqrt(sum));
    }
    return {force, depth};
  }
};

TEST_F(FirstLevelWindowTest, ABeanIsTouchedWithAProbe) {
  write_organ("bean", [](dvec3 p) { return dvec3(0.06 * p.x, 0.035 * p.y + 0.2 * 0.06 * p.x * p.x, 0.04 * p.z); });
  tell("bean", false, "Probe");
}

TEST_F(FirstLevelWindowTest, ALobeIsTouchedWithARod) {
  write_organ("lobe", [](dvec3 p) { return 0.05 * dvec3(1.4 * p.x, (0.6 + 0.2 * p.x) * p.y, p.z); });
  tell("lobe", true, "Rod");
}

TEST_F(FirstLevelWindowTest, AScannedOrganIsTouchedWithAProbe) {
  const fs::path organ = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid/hra/VH_F_Liver.glb";
  if (!fs::exists(organ)) GTEST_SKIP() << organ << " is missing: the corpus is not beside the repository";
  fs::copy_file(organ, folder / "liver.glb");
  tell("liver", false, "Probe");
}

}  // namespace
}  // namespace pliant::testing
