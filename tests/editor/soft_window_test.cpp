// An organ of several meshes in the editor: all its parts soft in one click, its sag before playing, the mouse that
// presses and drags it.
#include <cmath>

#include "content/files/image.h"
#include "content/gltf/write/gltf_save.h"
#include "content/level_file.h"
#include "tests/content/mesh_shapes.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class SoftWindowTest : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
    fs::create_directories(folder / "state");
    Level level;
    level.path = folder / "organ.glb";
    add(level, "capsule", 0.05f, vec3(0), 4);
    add(level, "lump", 0.012f, vec3(0.015f, 0.01f, 0), 2);
    add(level, "vessel", 0.015f, vec3(-0.02f, 0, 0.01f), 2);
    ASSERT_TRUE(save_level(level, folder / "organ.glb").ok());
  }
  static void add(Level& level, const char* name, float radius, vec3 centre, int finer) {
    Primitive ball = test::icosphere(finer);
    for (vec3& p : ball.position) p = radius * p + centre;
    LevelNode node;
    node.name = name;
    node.mesh = static_cast<std::int32_t>(level.meshes.size());
    level.meshes.push_back({name, {ball}});
    level.nodes.push_back(node);
  }
  Said edited(const std::string& script) const {
    write_text(folder / "script.txt", script);
    return pliant(
        {"edit", "organ.glb", "--size", "1280x900", "--config", "config", "--input", "script.txt", "--out", "shots"},
        "ASAN_OPTIONS=detect_leaks=0 XDG_STATE_HOME=" + quoted((folder / "state").string()) +
            " timeout 200 xvfb-run -a -s '-screen 0 1300x950x24'");
  }
  // Mean difference of the viewport in two screenshots, 0 to 255.
  double difference(const char* a, const char* b) const {
    const auto x = load_image(folder / "shots" / a), y = load_image(folder / "shots" / b);
    if (!x || !y || x->rgba.size() != y->rgba.size()) return 255.0;
    double sum = 0, count = 0;
    for (std::size_t row = x->height / 8; row < x->height / 2; ++row)
      for (std::size_t i = x->width; i < 3 * std::size_t{x->width}; ++i, ++count)
        sum += std::abs(int{x->rgba[row * 4 * x->width + i]} - int{y->rgba[row * 4 * x->width + i]});
    return sum / count;
  }
};

TEST_F(SoftWindowTest, AllPartsBecomeTissueItsSagIsShownAndTheMousePullsIt) {
  const Said said = edited(
      "click Scene/lump/row\nclick Tab/Tissue\nclick Tissue/All parts of this organ\n"
      "say takes along `lump`, `vessel`\n"
      "await Tissue/Tetrahedra/Finer\nclick Tissue/Pinned/Bottom\nwait 2\nawait Tissue/Gravity/Suggest pins\n"
      "wheel Tissue/Pinned/Bottom -6\nwait 1\nclick Tissue/Gravity/Show the sag\nwait 1\nscreenshot sag.png\n"
      "click Tissue/Gravity/Show the sag\n"
      "key Space\nawait Play/Pause\nwait 2\nmove Viewport@0.5,0.45\nwait 1\nscreenshot rest.png\n"
      "press Viewport@0.5,0.45 control\nwait 0.5\nmove Viewport@0.6,0.3\nwait 2\nscreenshot pulled.png\nrelease\nwait "
      "2\n"
      "move Viewport@0.5,0.45\nwait 1\npress Viewport@0.5,0.45\nwait 2\nscreenshot pressed.png\nrelease\nwait 1\n"
      "close\nclick Unsaved/Discard\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_GT(difference("rest.png", "pulled.png"), 0.5);
}

}  // namespace
}  // namespace pliant::testing
