// The first five minutes, by mouse alone and in at most 25 actions: an organ is opened, becomes tissue, is pinned, gets
// a lump, is touched with an instrument or a probe on a path set by clicks, is played and saved; and the file gives the
// same, tick for tick.
#include <cmath>

#include "content/level/script.h"
#include "content/level_file.h"
#include "tests/content/mesh_shapes.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

struct Story {
  const char* name;
  const char* organ;
  const char* tool;  // as its button says
  bool soft;
  const char* pins;  // what is pressed to pin it
};
std::ostream& operator<<(std::ostream& out, const Story& story) {
  return out << story.name;
}

class FirstLevelWindowTest : public CommandTest, public ::testing::WithParamInterface<Story> {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
#ifdef PLIANT_SANITIZED
    GTEST_SKIP() << "pictures take longer under the sanitizer than a step of the story waits";
#endif
    if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
    const std::string organ = GetParam().organ;
    if (organ == "bean")
      write_organ(organ, [](dvec3 p) { return dvec3(0.06 * p.x, 0.035 * p.y + 0.2 * 0.06 * p.x * p.x, 0.04 * p.z); });
    if (organ == "lobe")
      write_organ(organ, [](dvec3 p) { return 0.05 * dvec3(1.4 * p.x, (0.6 + 0.2 * p.x) * p.y, p.z); });
    if (organ == "liver") {
      const fs::path scanned = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid/hra/VH_F_Liver.glb";
      if (!fs::exists(scanned)) GTEST_SKIP() << scanned << " is missing: the corpus is not beside the repository";
      fs::copy_file(scanned, folder / "liver.glb");
    }
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

  static std::string name_of(const Story& it) {
    std::string name = it.tool;
    name[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
    return name;
  }
  static std::string text_of(const Story& it) {
    const std::string tool = it.tool;
    std::string story = std::string("click Start/Open organ…\nawait Files/Path\nclick Files/") + it.organ +
                        ".glb double\nawait Inspector/Search\nclick Viewport@0.5,0.5\nclick Tab/Tissue\n";
    story += it.soft ? "click Tissue/Soft body\nclick Tissue/Material/liver\nwheel Tissue/Material/liver -20\n" +
                           std::string(it.pins)
                     : "click Tissue/Surface\nclick Tissue/Material/liver\n";
    story += "click Tools/Paint\nwait 1\ndrag Viewport@0.48,0.5 to Viewport@0.52,0.5 in 0.3\n";
    story += "click Tools/Select\nclick Tab/Tissue\nwait 1\nwheel Tissue/Touch it with -20\n";
    story += "click Tissue/Instruments/" + tool + "\n";
    story += "click Tab/Path\nclick Path/Set keys\nclick Viewport@0.49,0.49\nclick Viewport@0.53,0.46\n";
    story += "click Path/Leave\nscreenshot keys.png\nclick Play/Play\nawait Play/Pause\n";
    story += "await Play/" + name_of(it) + " touches 200\nwait 2\nscreenshot play.png\n";
    story += "click Play/Stop\nawait Play/Play\nfelt felt.csv\n";
    return story + "click Menu/File\nclick Save\nawait Files/Save\nclick Files/Save\nhear Saved\nclose\n";
  }

  struct Felt {
    double force = 0.0, depth = 0.0;  // [N], [m]
  };
  // By tick, of the probe or tool of that name.
  std::map<std::uint64_t, Felt> felt(const fs::path& file, const std::string& name) const {
    std::map<std::uint64_t, Felt> all;
    const ForcesTable table = read_forces(file);
    const bool sums = std::find(table.columns.begin(), table.columns.end(), "force_N") != table.columns.end();
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      if (table.rows[i].at("probe") != name) continue;
      const auto number = [&](const char* column) { return table.number(i, column); };
      all[static_cast<std::uint64_t>(number("tick"))] = {
          sums ? number("force_N") : std::hypot(number("fx"), number("fy"), number("fz")), number("depth_m")};
    }
    return all;
  }
};

TEST_P(FirstLevelWindowTest, AnOrganIsTouchedAndTheFileFeelsTheSame) {
  const Story& it = GetParam();
  const std::string story = text_of(it), organ = it.organ;
  std::size_t actions = 0;
  std::istringstream lines(story);
  for (std::string line; std::getline(lines, line);)
    actions += line.starts_with("click") || line.starts_with("drag") || line.starts_with("wheel");
  EXPECT_LE(actions, 25u);
  write_text(folder / "story.txt", story);
  const Said said =
      pliant({"edit", "--size", "1280x720", "--config", "config", "--out", "shots", "--input", "story.txt"},
             "ASAN_OPTIONS=detect_leaks=0 XDG_STATE_HOME=state timeout 250 xvfb-run -a -s '-screen 0 1300x800x24'");
  ASSERT_EQ(said.status, 0) << said.err;
  const std::string level = organ + ".level.glb";
  EXPECT_EQ(pliant({"validate", level}).status, 0);
  const std::string name = name_of(it);
  const double end = load_script(folder / (organ + "_" + name + ".csv"))->rows.back().time;
  const Said run = pliant(
      {"run", level, "--headless", "--lockstep", "--seconds", std::to_string(end), "--frames", "0", "--out", "out"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto there = felt(folder / "out" / "forces.csv", name), here = felt(folder / "shots" / "felt.csv", name);
  Felt most;
  for (const auto& [tick, each] : there) {
    most.force = std::max(most.force, each.force);
    most.depth = std::max(most.depth, each.depth);
  }
  EXPECT_GT(most.force, 0.02) << "nothing is felt\n" << run.out;
  EXPECT_LT(most.force, 10.0) << run.out;
  // As deep as the keys say, 5 mm; of a tool, depth is how far its coupling is drawn.
  if (std::string(it.tool) == "Probe" && !it.soft) {
    EXPECT_LT(most.depth, 0.0052);
    EXPECT_GT(most.depth, 0.004);
  }
  // The first time along its path, before the editor's starts over.
  std::size_t same = 0;
  double felt_here = 0.0;
  for (const auto& [tick, each] : here) {
    if (static_cast<double>(tick) * 1e-3 > end - 0.01 || !there.contains(tick)) continue;
    const Felt& other = there.at(tick);
    ASSERT_NEAR(each.force, other.force, 1e-5 * (1.0 + other.force)) << "tick " << tick;
    ASSERT_NEAR(each.depth, other.depth, 1e-7) << "tick " << tick;
    felt_here = std::max(felt_here, each.force);
    ++same;
  }
  EXPECT_GT(same, 100u);
  EXPECT_GT(felt_here, 0.0) << "nothing is felt in the editor";
}

INSTANTIATE_TEST_SUITE_P(Organs, FirstLevelWindowTest,
                         ::testing::Values(Story{"ABeanWithAProbe", "bean", "Probe", false, ""},
                                           Story{"ABeanWithARod", "bean", "Rod", true, "click Tissue/Pinned/Bottom\n"},
                                           Story{"ALobeWithAProbe", "lobe", "Probe", true,
                                                 "click Tissue/Pinned/Bottom\n"},
                                           Story{"ALobeWithARod", "lobe", "Rod", true, "click Tissue/Pinned/Bottom\n"},
                                           Story{"AScannedOrganWithAProbe", "liver", "Probe", false, ""},
                                           Story{"AScannedOrganWithARod", "liver", "Rod", false, ""}),
                         [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace pliant::testing
