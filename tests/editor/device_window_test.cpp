// The panel of devices in the editor, pressed by a script: a level that asks for a device is played with it, it arms
// itself, is stopped by the key and armed by the button; the inspector picks which.
#include "tests/editor/shell_window.h"

namespace pliant::testing {
namespace {

class DeviceWindowTest : public EditorWindow {
 protected:
  void SetUp() override {
    EditorWindow::SetUp();
    for (const char* name : {"minimal.gltf", "minimal.bin"})
      fs::copy_file(fs::path(PLIANT_SOURCE_DIR) / "content/levels" / name, folder / name);
  }
  void level_wants(const std::string& id) const {
    Json level = Json::parse(read_text(folder / "minimal.gltf"));
    for (Json& node : level["nodes"])
      if (node.contains("extensions") && node["extensions"].contains("PLIANT_haptic_device"))
        node["extensions"]["PLIANT_haptic_device"] = {{"driver", "external"}, {"id", id}};
    write_text(folder / "minimal.gltf", level.dump(2));
  }
  Said edited(const std::string& script) const { return edit("minimal.gltf", script); }
};

TEST_F(DeviceWindowTest, ALevelsDeviceIsPlayedStoppedByTheKeyAndArmedByThePanel) {
  level_wants("falcon; simulated:touch");
  const Said said = edited(
      "click Tab/Devices\nawait Devices/Look again\nclick Play/Play\nsay falcon\n"
      "hear plays in real time\nawait Devices/tip/Active 20\nwait 0.3\nscreenshot active.png\n"
      "key F9\nawait Devices/tip/Stopped 20\nsay emergency stop\nwait 0.3\nscreenshot stopped.png\n"
      "expect-no Devices/tip/Disarm\nclick Devices/tip/Arm\nawait Devices/tip/Active 20\n"
      "click Devices/tip/Disarm\nawait Devices/tip/Idle 20\nclick Devices/tip/Arm\n"
      "await Devices/tip/Active 20\nclick Devices/tip/Stop\nawait Devices/tip/Stopped 20\n"
      "click Devices/tip/Arm\nawait Devices/tip/Active 20\nclick Devices/Stop all\n"
      "await Devices/tip/Stopped 20\nkey Shift+Space\nclose\n");
  EXPECT_EQ(said.status, 0) << said.err;
}

TEST_F(DeviceWindowTest, WhereNoDeviceIsThereTheMouseTakesItsPlace) {
  level_wants("falcon; mouse");
  const Said said = edited(
      "click Play/Play\nawait Play/Pause\nhear falcon\nwait 0.5\nclick Tab/Devices\nscreenshot none.png\n"
      "press Viewport@0.5,0.45\nwait 1\nrelease\nkey Shift+Space\nclose\n");
  EXPECT_EQ(said.status, 0) << said.err;
}

TEST_F(DeviceWindowTest, TheInspectorPicksWhichDeviceFromTheListAndThePlayPanelOffersIt) {
  level_wants("any-force");
  const Said said = edited(
      "click Scene/tip/row\nawait Pick device\nclick Pick device\nawait Pick device/any-pose; mouse\n"
      "screenshot pick.png\nclick Pick device/any-pose; mouse\nclick Tab/Play\n"
      "click source/tip\nawait source/tip/any-force\nwait 0.3\nscreenshot sources.png\n"
      "await source/tip/simulated 20\nwheel source/tip/any-force -10\nwait 0.3\nclick source/tip/simulated\nwait "
      "0.3\nclick Viewport@0.9,0.9\nkey Ctrl+S\nsay "
      "Saved\nclose\n");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(read_text(folder / "minimal.gltf").find("any-pose; mouse"), std::string::npos);
}

// A level may name kinds of devices; for more the user is asked, once for a file and its words.
TEST_F(DeviceWindowTest, ALevelThatAsksForMoreThanItMayIsPlayedOnceTheUserHasAllowedIt) {
  const std::string written = (folder / "stolen.csv").string();
  level_wants("simulated:touch|record=" + written);
  const Said refused = edited(
      "click Play/Play\nawait Question/Allow for this file\nscreenshot asked.png\nclick Question/Cancel\n"
      "expect-no Question/Allow for this file\nclick Play/Play\nclick Question/Play without\nawait Play/Pause\n"
      "wait 1\nkey Shift+Space\nclose\n");
  EXPECT_EQ(refused.status, 0) << refused.err;
  EXPECT_FALSE(fs::exists(written)) << "a file was written for a level that nobody has allowed it";
  const Said allowed =
      edited("click Play/Play\nclick Question/Allow for this file\nawait Play/Pause\nwait 1\nkey Shift+Space\nclose\n");
  EXPECT_EQ(allowed.status, 0) << allowed.err;
  EXPECT_TRUE(fs::exists(written));
  const Said again = edited("click Play/Play\nawait Play/Pause\nkey Shift+Space\nclose\n");
  EXPECT_EQ(again.status, 0) << again.err;
  level_wants("simulated:touch|record=" + written + ".csv");
  const Said others = edited("click Play/Play\nclick Question/Cancel\nclose\n");
  EXPECT_EQ(others.status, 0) << others.err;
}

}  // namespace
}  // namespace pliant::testing
