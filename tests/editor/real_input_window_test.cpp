// Keys and clicks of a real X server during a slow frame: the editor is stopped, all input is sent, then it continues
// and finds everything in its queue at once.
#include "tests/editor/shell_window.h"

namespace pliant::testing {
namespace {

class RealInputWindowTest : public ShellWindow {
 protected:
  // `hand`: lines of a shell that act on the window W; `act` stops the editor meanwhile.
  Said by_hand(const std::string& hand) const {
    write_text(folder / "hand.sh",
               "\"$PLIANT\" edit small.glb --size 1280x720 --config config & P=$!\n"
               "W=$(timeout 60 xdotool search --sync --onlyvisible --pid $P | tail -1)\n"
               "xdotool windowfocus --sync $W; xdotool mousemove --window $W 640 300; sleep 2\n"
               "act() { kill -STOP $P; xdotool \"$@\"; kill -CONT $P; sleep 1; }\n" +
                   hand +
                   "\nfor i in $(seq 100); do kill -0 $P 2>/dev/null || break; sleep 0.1; done; kill -9 $P "
                   "2>/dev/null; wait $P\n");
    write_text(folder / "sh.out", "");
    const std::string line = "cd " + quoted(folder.string()) +
                             " && env -u DISPLAY -u WAYLAND_DISPLAY PLIANT=" + quoted(PLIANT_BINARY) + " " + around() +
                             " sh hand.sh >sh.out 2>&1";
    const int status = std::system(line.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, read_text(folder / "sh.out"), ""};
  }
};

TEST_F(RealInputWindowTest, WhatIsTypedDuringASlowFrameIsAllThereAndInItsOrder) {
  if (std::system("command -v xdotool >/dev/null 2>&1") != 0) GTEST_SKIP() << "xdotool is missing; install it";
  // Everything is selected, the last of it renamed, saved and closed: within four frames.
  const Said said = by_hand(
      "act key ctrl+a key F2\n"
      "act type thumbs; act key BackSpace key BackSpace type bing\n"
      "act key Return key ctrl+s\n"
      "act key ctrl+q\n");
  EXPECT_EQ(said.status, 0) << said.out;
  EXPECT_NE(document("small.glb").state().find("thumbing"), nullptr) << said.out;
}

TEST_F(RealInputWindowTest, AClickOfOneSlowFrameIsAClickAndTwoAreADoubleOne) {
  if (std::system("command -v xdotool >/dev/null 2>&1") != 0) GTEST_SKIP() << "xdotool is missing; install it";
  // The row of the finger is the second of the tree.
  const Said said = by_hand(
      "act mousemove --window $W 90 127 click 1 key Delete\n"
      "act key ctrl+s\nact key ctrl+q\n");
  EXPECT_EQ(said.status, 0) << said.out;
  EXPECT_EQ(document("small.glb").state().find("finger"), nullptr) << said.out;
  EXPECT_NE(document("small.glb").state().find("sheet"), nullptr) << said.out;
}

}  // namespace
}  // namespace pliant::testing
