// Pictures that somebody has looked at (golden/). To make them anew: PLIANT_WRITE_GOLDEN=FOLDER test_visual
// --gtest_filter='Feature.*:Skin.*', look, then copy.
#pragma once

#include <string>

#include "components/appearance.h"

namespace pliant::test {

inline constexpr double kTolerance = 1.0;  // [of 255] see perceived_difference

// The picture `on` against golden/NAME.png, and `off`, which lacks what the test is about, against both: it must fail.
void expect_golden(const std::string& name, const Image& on, const Image& off);

}  // namespace pliant::test
