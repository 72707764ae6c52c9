// Playing in the window, as a hand does it: buttons, keys, the mouse on the surface, going back.
#include "tests/editor/editor_window.h"

namespace pliant::testing {
namespace {

TEST_F(WindowTest, PlayPressPauseStepGoBackGoOnAndStopByHand) {
  const Said said = edited("content/levels/minimal.gltf", R"(
click View mode/Rendered
screenshot rendered.png
click Play/Play
await Play/Pause
wait 1
press Viewport@0.5,0.5
wait 1.5
screenshot pressed.png
wait 0.3
release
key Space
await Play/Step
key .
click Play/Step
click Plots/Time line@0.5,0.5
await Plots/Go on from here
screenshot back.png
click Plots/Go on from here
await Play/Pause
wait 0.5
click Tab/Play
screenshot panel.png
click Play/Clock
click Play/Clock
key Shift+Space
await Play/Play
expect View mode/Rendered
close
)");
  ASSERT_EQ(said.status, 0) << said.err;
  for (const char* name : {"rendered.png", "pressed.png", "back.png", "panel.png"})
    EXPECT_GT(contrast(folder / "shots" / name), 10.0) << name;
}

TEST_F(WindowTest, ClosingWhileItPlaysEndsAtOnce) {
  const Said said = edited("content/levels/minimal.gltf", "key Space\nawait Play/Pause\nwait 0.5\nclose\n");
  EXPECT_EQ(said.status, 0) << said.err;
}

}  // namespace
}  // namespace pliant::testing
