// Two pictures, as an eye compares them.
#pragma once

#include <filesystem>
#include <optional>

#include "components/appearance.h"

namespace pliant::test {

// [0, 255] Mean absolute difference of the channels after a blur over 5 x 5 pixels, which tolerates differences between
// drivers at edges. Pictures of different sizes differ by 255.
double perceived_difference(const Image& a, const Image& b);

std::optional<Image> read_png(const std::filesystem::path& path);

}  // namespace pliant::test
