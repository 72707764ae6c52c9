#include "content/files/image.h"

#include <gtest/gtest.h>

namespace pliant::test {
namespace {

TEST(Image, PngIsLosslessBothWays) {
  std::vector<std::uint8_t> pixels;
  for (std::uint32_t i = 0; i < 17 * 9 * 4; ++i) pixels.push_back(static_cast<std::uint8_t>(i * 37 + i / 4));
  const Result<Image> image = decode_image(encode_png(17, 9, pixels.data()), "test");
  ASSERT_TRUE(image.ok()) << image.error().message();
  EXPECT_EQ(image->width, 17u);
  EXPECT_EQ(image->height, 9u);
  EXPECT_EQ(image->rgba, pixels);
}

TEST(Image, EveryTruncationIsReadOrRefusedAndNeverCrashes) {
  const std::vector<std::uint8_t> pixels(64 * 64 * 4, 7);
  const Bytes whole = encode_png(64, 64, pixels.data());
  EXPECT_FALSE(decode_image(std::span(whole).first(whole.size() / 2), "cut").ok());
  for (std::size_t size = 0; size < whole.size(); ++size)
    if (const Result<Image> image = decode_image(std::span(whole).first(size), "cut"); image)
      EXPECT_EQ(image->rgba.size(), pixels.size());
}

TEST(Image, AHeaderThatClaimsImmenseSizeIsRefusedBeforeMemoryIsTaken) {
  const std::vector<std::uint8_t> pixels(4 * 4 * 4, 7);
  Bytes png = encode_png(4, 4, pixels.data());
  for (const auto& [high, low] : {std::pair{0x7f, 0}, std::pair{0, 0x1f}}) {  // width and height in bytes 16 to 23
    png[16] = png[20] = static_cast<std::uint8_t>(high);
    png[18] = png[22] = static_cast<std::uint8_t>(low);
    const Result<Image> image = decode_image(png, "claims");
    ASSERT_FALSE(image.ok());
  }
}

TEST(Image, OtherFormatsAreRefusedByName) {
  const std::uint8_t gif[] = {'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0};
  const Result<Image> image = decode_image(gif, "picture.gif");
  ASSERT_FALSE(image.ok());
  EXPECT_NE(image.error().message().find("neither PNG nor JPEG"), std::string::npos);
}

}  // namespace
}  // namespace pliant::test
