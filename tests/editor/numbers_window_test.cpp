// Text typed into number fields: with units, with arithmetic, or rejected with a sentence.
#include <fmt/format.h>

#include "content/level_file.h"
#include "tests/editor/small_level.h"
#include "tests/player/command.h"

namespace pliant::testing {
namespace {

class NumbersWindowTest : public CommandTest {
 protected:
  // The node `sheet` after the script, in a window 1280 pixels wide.
  LevelNode edited(const std::string& script, int height) {
    EXPECT_TRUE(save_level(sheet_and_finger(), folder / "small.glb").ok());
    write_text(folder / "script.txt", script);
    const Said said = pliant(
        {"edit", "small.glb", "--size", fmt::format("1280x{}", height), "--config", "config", "--input", "script.txt",
         "--out", "shots"},
        fmt::format("ASAN_OPTIONS=detect_leaks=0 timeout 200 xvfb-run -a -s '-screen 0 1300x{}x24'", height + 100));
    EXPECT_EQ(said.status, 0) << said.err;
    const Result<Level> level = load_level(folder / "small.glb");
    EXPECT_TRUE(level.ok()) << level.error().message();
    return level.ok() ? level->nodes[0] : LevelNode{};
  }
};

TEST_F(NumbersWindowTest, AreTakenWithTheirUnitsOrRefused) {
  if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
  const LevelNode sheet = edited(R"(
await Inspector/Search
click Scene/sheet/row
click Tab/Inspector
set Inspector/deformable/stiffness 0.5 N/mm
set Inspector/deformable/stiffness 5 kg
say of another kind than N/m
set Inspector/deformable/stiffness 1e12
say is out of range
set Inspector/deformable/reach 5 mm
set Inspector/deformable/reach 1,000
say can be 1000 or 1.000
set Inspector/Position x 1/10
set Inspector/Position y 0,1
key Ctrl+S
hear Saved
close
)",
                                 1000);
  ASSERT_TRUE(sheet.deformable);
  EXPECT_EQ(sheet.deformable->stiffness, 500.0);
  EXPECT_EQ(sheet.deformable->reach, 0.005);
  EXPECT_EQ(sheet.local.translation.x, 0.1f);
  EXPECT_EQ(sheet.local.translation.y, 0.1f);
}

TEST_F(NumbersWindowTest, ASurfacesEffectsAreSetAndSaved) {
  if (std::system("command -v xvfb-run >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "xvfb-run is missing; install xvfb and xauth";
  const LevelNode sheet = edited(R"(
await Inspector/Search
click Scene/sheet/row
click Tab/Inspector
set Inspector/deformable/texture.amplitude 0.05 mm
set Inspector/deformable/texture.wavelength 2 mm
set Inspector/deformable/texture.seed 1.5
say must be a whole number
set Inspector/deformable/texture.seed 7
set Inspector/deformable/transient.amplitude 20
set Inspector/deformable/transient.frequency 150
set Inspector/deformable/transient.decay 60
set Inspector/deformable/friction_stribeck 20 mm/s
set Inspector/deformable/friction_viscous 0.25
key Ctrl+S
hear Saved
close
)",
                                 1900);
  ASSERT_TRUE(sheet.deformable);
  const Deformable& skin = *sheet.deformable;
  EXPECT_DOUBLE_EQ(skin.texture_amplitude, 5e-5);
  EXPECT_DOUBLE_EQ(skin.texture_wavelength, 2e-3);
  EXPECT_EQ(skin.texture_seed, 7.0);
  EXPECT_EQ(skin.transient_amplitude, 20.0);
  EXPECT_EQ(skin.transient_frequency, 150.0);
  EXPECT_EQ(skin.transient_decay, 60.0);
  EXPECT_DOUBLE_EQ(skin.friction_stribeck, 0.02);
  EXPECT_EQ(skin.friction_viscous, 0.25);
}

}  // namespace
}  // namespace pliant::testing
