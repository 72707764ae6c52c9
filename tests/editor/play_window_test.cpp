// Playing in the window: buttons, keys, the mouse on the surface, going back.
#include <cmath>

#include "content/files/image.h"
#include "content/level_file.h"
#include "tests/content/mesh_shapes.h"
#include "tests/editor/shell_window.h"

namespace pliant::testing {
namespace {

// Standard deviation of the pixel values in a part of a picture, 0 to 255.
double contrast(const Image& image, double left, double top, double right, double bottom) {
  double sum = 0, squares = 0, count = 0;
  for (auto y = static_cast<std::size_t>(top * image.height); y < static_cast<std::size_t>(bottom * image.height); ++y)
    for (auto x = static_cast<std::size_t>(left * image.width); x < static_cast<std::size_t>(right * image.width); ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const double v = image.rgba[4 * (y * image.width + x) + c];
        sum += v;
        squares += v * v;
        ++count;
      }
  return std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
}

class PlayWindowTest : public EditorWindow {
 protected:
  void SetUp() override {
    EditorWindow::SetUp();
    for (const char* name : {"minimal.gltf", "minimal.bin", "minimal.csv"})
      fs::copy_file(fs::path(PLIANT_SOURCE_DIR) / "content/levels" / name, folder / name);
  }
  Said edited(const std::string& script, const std::string& level = "minimal.gltf") const {
    return edit(level, script);
  }
  Image shot(const std::string& name) const {
    auto image = load_image(folder / "shots" / name);
    EXPECT_TRUE(image) << name;
    return image ? *std::move(image) : Image();
  }
};

TEST_F(PlayWindowTest, ALevelIsPlayedPressedPausedSteppedTakenBackAndStoppedByHand) {
  const Said said = edited(
      "click View mode/Rendered\nscreenshot rendered.png\n"
      "click Play/Play\nawait Play/Pause\nwait 1\n"
      "press Viewport@0.5,0.45\nwait 2\nscreenshot pressed.png\nwait 0.3\nrelease\nwait 1\n"
      "key Space\nawait Play/Step\nkey .\nclick Play/Step\n"
      "click Plots/mouse\n"
      "click Plots/Time line@0.5,0.5\nawait Plots/Go on from here\nwait 0.5\nscreenshot back.png\n"
      "click Plots/Go on from here\nawait Play/Pause\nwait 0.5\n"
      "click Tab/Play\nscreenshot panel.png\nwait 0.3\n"
      "click Play/1/2\nwait 0.3\n"
      "key Shift+Space\nwait 0.3\nscreenshot stopped.png\nexpect View mode/Rendered\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  // The picture is in the upper middle, the plots below it.
  for (const char* name : {"rendered.png", "pressed.png", "back.png", "stopped.png"})
    EXPECT_GT(contrast(shot(name), 0.22, 0.08, 0.72, 0.65), 5.0) << name << ": no picture";
  EXPECT_GT(contrast(shot("pressed.png"), 0.22, 0.74, 0.72, 0.95), 8.0) << "nothing is plotted";
}

TEST_F(PlayWindowTest, WhatTheMouseDidIsRecordedAsAPathThatIsSavedWithTheLevel) {
  const Said said = edited(
      "click Tab/Play\nclick Play/Play\nawait Play/Pause\nwait 0.5\n"
      "press Viewport@0.5,0.45\nwait 1\nmove Viewport@0.55,0.45\nwait 0.5\nrelease\nwait 0.5\n"
      "key Shift+Space\nawait Play/Record/Record path of mouse\nscreenshot record.png\n"
      "click Record/Record path of mouse\nsay mm from the run\nawait Path/Row 1/time\nscreenshot recorded.png\n"
      "click Viewport@0.9,0.9\nkey Ctrl+S\nsay Saved\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  bool there = false;
  for (const auto& each : fs::directory_iterator(folder))
    if (each.path().extension() == ".csv" && each.path().filename() != "minimal.csv")
      there = read_text(each.path()).find("# key ") != std::string::npos;
  EXPECT_TRUE(there) << "no script with its keys was saved";
}

TEST_F(PlayWindowTest, ClosingWhileItPlaysEndsItWithoutAWord) {
  const Said said = edited("key Space\nawait Play/Pause\nwait 0.5\nclose\n");
  EXPECT_EQ(said.status, 0) << said.err;
}

// Pixels of a warning, yellow, where what a run finds is written: the upper left of the viewport.
std::size_t warned(const Image& image) {
  std::size_t yellow = 0;
  for (std::size_t y = 70; y < 140; ++y)
    for (std::size_t x = 262; x < 640; ++x) {
      const std::uint8_t* const p = &image.rgba[4 * (y * image.width + x)];
      yellow += p[0] > 150 && p[1] > 110 && p[0] > 2 * p[2];
    }
  return yellow;
}

TEST_F(PlayWindowTest, WhatAProbeDoesNotFeelIsWrittenOverThePicture) {
  Level level;
  level.meshes.push_back({"ball", {pliant::test::icosphere(3)}});
  for (vec3& p : level.meshes[0].primitives[0].position) p *= 0.03f;
  LevelNode ball, tip;
  ball.name = "ball";
  ball.mesh = 0;
  ball.deformable.emplace();
  tip.name = tip.probe_device = "tip";
  tip.probe.emplace();
  tip.device.emplace();
  tip.device->driver = DriverKind::kScript;
  tip.device->file = "tip.csv";
  level.nodes = {ball, tip};
  ASSERT_TRUE(save_level(level, folder / "ball.glb").ok());
  const struct {
    const char *rows, *said;
  } paths[] = {{"0,0,0.08,0\n0.5,0.01,0.08,0\n", "has touched nothing on its path"},
               {"0,0,0.08,0\n0.5,0,0.028,0\n", ""}};
  for (const auto& [rows, said] : paths) {
    write_text(folder / "tip.csv", std::string("time_s,x,y,z\n") + rows);
    const std::string words = said;
    const Said done =
        edited("await Inspector/Search\nscreenshot before.png\nclick Play/Play\nawait Play/Pause\nwait 2\n" +
                   (words.empty() ? std::string() : "await Play/tip " + words + " 30\n") +
                   "screenshot after.png\nclick Play/Stop\nclose\n",
               "ball.glb");
    ASSERT_EQ(done.status, 0) << rows << done.err;
    EXPECT_EQ(warned(shot("before.png")), 0u) << rows;
    if (words.empty())
      EXPECT_EQ(warned(shot("after.png")), 0u) << rows;
    else
      EXPECT_GT(warned(shot("after.png")), 200u) << rows;
  }
}

}  // namespace
}  // namespace pliant::testing
