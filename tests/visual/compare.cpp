#include "tests/visual/compare.h"

#include <stb_image.h>

#include <algorithm>
#include <cmath>

namespace pliant::test {
namespace {

constexpr int kReach = 2;  // [pixels] of the blur, to each side

// Channel c about pixel (x, y).
double blurred(const Image& image, int x, int y, int c) {
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  double sum = 0;
  for (int j = -kReach; j <= kReach; ++j)
    for (int i = -kReach; i <= kReach; ++i) {
      const int px = std::clamp(x + i, 0, width - 1), py = std::clamp(y + j, 0, height - 1);
      sum += image.rgba[4 * static_cast<std::size_t>(py * width + px) + static_cast<std::size_t>(c)];
    }
  return sum / ((2 * kReach + 1) * (2 * kReach + 1));
}

}  // namespace

double perceived_difference(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.rgba.size() != b.rgba.size() || a.rgba.empty()) return 255;
  double sum = 0;
  for (int y = 0; y < static_cast<int>(a.height); ++y)
    for (int x = 0; x < static_cast<int>(a.width); ++x)
      for (int c = 0; c < 3; ++c) sum += std::abs(blurred(a, x, y, c) - blurred(b, x, y, c));
  return sum / (3.0 * a.width * a.height);
}

std::optional<Image> read_png(const std::filesystem::path& path) {
  int width = 0, height = 0, channels = 0;
  std::uint8_t* pixels = stbi_load(path.c_str(), &width, &height, &channels, 4);
  if (!pixels) return std::nullopt;
  Image image{path.filename().string(), static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
              std::vector<std::uint8_t>(pixels, pixels + std::size_t{4} * static_cast<std::size_t>(width * height))};
  stbi_image_free(pixels);
  return image;
}

}  // namespace pliant::test
