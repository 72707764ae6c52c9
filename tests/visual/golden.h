// Manually verified pictures (golden/). To renew them: PLIANT_WRITE_GOLDEN=FOLDER test_visual
// --gtest_filter='Feature.*:Skin.*', check them, then copy.
#pragma once

#include <string>

#include "components/appearance.h"

namespace pliant::test {

inline constexpr double kTolerance = 1.0;  // [of 255] see perceived_difference

// Compares the picture `on` with golden/NAME.png. `off`, without the tested feature, must differ from both.
void expect_golden(const std::string& name, const Image& on, const Image& off);

}  // namespace pliant::test
