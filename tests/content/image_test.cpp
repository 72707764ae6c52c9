#include "content/files/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stb_image_write.h>

#include <algorithm>

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

Bytes gray_jpeg() {
  Bytes jpeg;
  const std::vector<std::uint8_t> pixels(16 * 16 * 3, 128);
  stbi_write_jpg_to_func(
      [](void* out, void* data, int size) {
        const auto* begin = static_cast<const std::uint8_t*>(data);
        static_cast<Bytes*>(out)->insert(static_cast<Bytes*>(out)->end(), begin, begin + size);
      },
      &jpeg, 16, 16, 3, pixels.data(), 90);
  return jpeg;
}

Bytes with_segment(const Bytes& jpeg, const Bytes& segment) {  // directly after the start of the image
  Bytes out = jpeg;
  out.insert(out.begin() + 2, segment.begin(), segment.end());
  return out;
}

// Other decoders write beyond their table (stb_image 2.27, stbi__build_huffman).
TEST(Image, AJpegWhoseHuffmanTableNamesMoreThan256CodesIsRefused) {
  const Bytes jpeg = gray_jpeg();
  ASSERT_TRUE(decode_image(jpeg, "gray").ok());
  for (const int too_many : {1, 2, 255}) {
    Bytes table = {0x00};  // of DC 0: 255 codes of 16 bits, and some of 15
    table.resize(15, 0);
    table.insert(table.end(), {static_cast<std::uint8_t>(too_many), 255});
    Bytes segment = {0xff, 0xff, 0xc4, 0x02, 0x14};  // 2 + 17 + 513 bytes, behind a byte of padding
    segment.insert(segment.end(), table.begin(), table.end());
    Bytes full = segment;
    full.resize(full.size() + 513, 0);
    for (const Bytes& damaged : {full, segment}) {
      const Result<Image> image = decode_image(with_segment(jpeg, damaged), "picture.jpg");
      if (too_many == 1 && image.ok()) continue;  // 256: the number of possible codes
      ASSERT_FALSE(image.ok()) << too_many;
      EXPECT_THAT(image.error().message(), testing::StartsWith("picture.jpg: is a damaged JPEG ("));
      EXPECT_EQ(decoded_size(with_segment(jpeg, damaged)) == 0, !image.ok());
    }
  }
}

TEST(Image, WhatLooksLikeATableInsideAnotherSegmentOfAJpegIsNone) {
  Bytes note = {0xff, 0xe2, 0x00, 0x20, 0xff, 0xc4, 0x02, 0x14};
  note.resize(2 + 0x20, 0xff);
  const Result<Image> image = decode_image(with_segment(gray_jpeg(), note), "profile");
  ASSERT_TRUE(image.ok()) << image.error().message();
  EXPECT_NEAR(image->rgba[0], 128, 1);
}

// Other decoders read a table that no segment defined (stb_image 2.27, stbi__jpeg_huff_decode).
TEST(Image, AJpegWithoutTablesHasThoseOfTheStandardAndOneThatIsCutOffIsRefused) {
  const Bytes jpeg = gray_jpeg();
  Bytes without;
  for (std::size_t at = 0; at < jpeg.size();) {
    if (at + 3 < jpeg.size() && jpeg[at] == 0xff && jpeg[at + 1] == 0xc4)
      at += std::size_t{2} + (jpeg[at + 2] << 8 | jpeg[at + 3]);
    else
      without.push_back(jpeg[at++]);
  }
  ASSERT_LT(without.size(), jpeg.size());
  const Result<Image> standard = decode_image(without, "picture.jpg");
  ASSERT_TRUE(standard.ok()) << standard.error().message();
  EXPECT_NEAR(standard->rgba[0], 128, 1);
  const Result<Image> cut = decode_image(std::span(jpeg).first(jpeg.size() - 6), "picture.jpg");
  ASSERT_FALSE(cut.ok());
  EXPECT_EQ(cut.error().message(), "picture.jpg: is a damaged JPEG (Premature end of JPEG file); save it again");
}

TEST(Image, OtherFormatsAreRefusedByName) {
  const std::uint8_t gif[] = {'G', 'I', 'F', '8', '9', 'a', 1, 0, 1, 0};
  const Result<Image> image = decode_image(gif, "picture.gif");
  ASSERT_FALSE(image.ok());
  EXPECT_NE(image.error().message().find("neither PNG nor JPEG"), std::string::npos);
}

}  // namespace
}  // namespace pliant::test
