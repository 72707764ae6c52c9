// Drags that move the view, as in other programs.
#include <gtest/gtest.h>

#include "editor/app/navigation.h"

namespace pliant::test {
namespace {

TEST(Navigation, EveryPresetTurnsShiftsAndZoomsAsItsProgramDoes) {
  using M = ViewMotion;
  const ViewDrag left{.left = true}, right{.right = true}, middle{.middle = true};
  const auto with = [](ViewDrag drag, bool shift, bool control, bool alt) {
    drag.shift = shift, drag.control = control, drag.alt = alt;
    return drag;
  };
  const ViewDrag shift = with(middle, true, false, false), control = with(middle, false, true, false);
  EXPECT_EQ(view_motion("", left), M::kTurn);
  EXPECT_EQ(view_motion("", middle), M::kShift);
  EXPECT_EQ(view_motion("", with(left, true, false, false)), M::kShift);
  EXPECT_EQ(view_motion("Blender", left), M::kNone) << "left selects";
  EXPECT_EQ(view_motion("Blender", middle), M::kTurn);
  EXPECT_EQ(view_motion("Blender", shift), M::kShift);
  EXPECT_EQ(view_motion("Blender", control), M::kZoom);
  EXPECT_EQ(view_motion("CAD", shift), M::kZoom);
  EXPECT_EQ(view_motion("CAD", control), M::kShift);
  EXPECT_EQ(view_motion("Maya", middle), M::kNone);
  EXPECT_EQ(view_motion("Maya", with(left, false, false, true)), M::kTurn);
  EXPECT_EQ(view_motion("Maya", with(middle, false, false, true)), M::kShift);
  EXPECT_EQ(view_motion("Maya", with(right, false, false, true)), M::kZoom);
}

}  // namespace
}  // namespace pliant::test
