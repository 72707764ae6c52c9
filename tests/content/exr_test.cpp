// OpenEXR panoramas written here and read back.
#include "content/files/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <limits>

#include "content/files/file_io.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

// A picture of these float channels, each width*height long, as a file's bytes.
Bytes exr(int width, int height, const std::vector<std::pair<std::string, std::vector<float>>>& channels, int x0 = 0,
          int y0 = 0) {
  const fs::path path = fs::temp_directory_path() / ("pliant-exr-test-" + std::to_string(::getpid()) + ".exr");
  const Imath::Box2i window(Imath::V2i(x0, y0), Imath::V2i(x0 + width - 1, y0 + height - 1));
  Imf::Header header(window, window, 1, Imath::V2f(0, 0), 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
  Imf::FrameBuffer frame;
  for (const auto& [name, values] : channels) {
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    char* origin =
        const_cast<char*>(reinterpret_cast<const char*>(values.data())) - 4 * x0 - 4 * std::ptrdiff_t{width} * y0;
    frame.insert(name, Imf::Slice(Imf::FLOAT, origin, 4, 4 * static_cast<std::size_t>(width)));
  }
  {
    Imf::OutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(height);
  }
  Result<Bytes> bytes = read_file(path);
  fs::remove(path);
  return bytes ? *bytes : Bytes{};
}

TEST(Exr, PixelsComeTopToBottomAsWrittenWhereverTheDataWindowLies) {
  std::vector<float> r, g, b;
  for (int i = 0; i < 6; ++i) r.push_back(static_cast<float>(i)), g.push_back(0.25f), b.push_back(1e4f);
  for (const int origin : {0, 40, -7}) {
    const Bytes bytes = exr(3, 2, {{"R", r}, {"G", g}, {"B", b}}, origin, -origin);
    const Result<Panorama> panorama = decode_panorama(bytes, "test");
    ASSERT_TRUE(panorama.ok()) << panorama.error().message();
    EXPECT_EQ(panorama->width, 3u);
    EXPECT_EQ(panorama->height, 2u);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_EQ(panorama->rgb[3 * i], r[i]);
      EXPECT_EQ(panorama->rgb[3 * i + 1], 0.25f);
      EXPECT_EQ(panorama->rgb[3 * i + 2], 1e4f);
    }
  }
}

TEST(Exr, LuminanceBecomesGrey) {
  const Bytes bytes = exr(2, 1, {{"Y", {0.5f, 3.0f}}});
  const Result<Panorama> panorama = decode_panorama(bytes, "test");
  ASSERT_TRUE(panorama.ok());
  EXPECT_EQ(panorama->rgb, (std::vector<float>{0.5f, 0.5f, 0.5f, 3.0f, 3.0f, 3.0f}));
}

TEST(Exr, WhatNoLightCanBeIsZeroAndCounted) {
  const float inf = std::numeric_limits<float>::infinity();
  const Bytes bytes = exr(2, 2, {{"R", {NAN, inf, -inf, -1.0f}}, {"G", {1, 1, 1, 1}}, {"B", {0, 0, 0, 0}}});
  std::vector<std::string> notes;
  const Result<Panorama> panorama = decode_panorama(bytes, "test", &notes);
  ASSERT_TRUE(panorama.ok());
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(panorama->rgb[3 * i], 0.0f);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("4 values"), std::string::npos) << notes[0];
}

TEST(Exr, EveryTruncationIsRefusedInASentence) {
  const std::vector<float> grey(64, 0.5f);
  const Bytes whole = exr(8, 8, {{"R", grey}, {"G", grey}, {"B", grey}});
  for (std::size_t size = 0; size + 1 < whole.size(); ++size) {
    const Result<Panorama> panorama = decode_panorama(std::span(whole).first(size), "cut.exr");
    ASSERT_FALSE(panorama.ok()) << size;
    ASSERT_EQ(panorama.error().message().rfind("cut.exr: ", 0), 0u);
  }
}

// The library reads the size of the type, not the attribute's claimed size. If they differed, it would parse the rest
// of the header at a wrong offset, as attributes of any size.
TEST(Exr, AnAttributeOfAnotherSizeThanItsTypeIsRefusedBeforeTheLibrarySeesIt) {
  const std::vector<float> ramp{1.0f, 2.0f};
  const Bytes whole = exr(2, 1, {{"R", ramp}, {"G", ramp}, {"B", ramp}});
  for (const char* type : {"box2i", "chlist", "v2f", "float"}) {
    Bytes bytes = whole;
    const std::string text(bytes.begin(), bytes.end()), word = std::string(1, '\0') + type + std::string(1, '\0');
    const std::size_t at = text.find(word);
    ASSERT_NE(at, std::string::npos) << type;
    const std::size_t size_at = at + word.size();
    std::uint32_t size = 0;
    std::memcpy(&size, bytes.data() + size_at, 4);
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(size_at + 4 + size), std::uint8_t{0});
    ++size;
    std::memcpy(bytes.data() + size_at, &size, 4);
    const Result<Panorama> panorama = decode_panorama(bytes, "test");
    ASSERT_FALSE(panorama.ok()) << type;
    EXPECT_NE(panorama.error().message().find("damaged"), std::string::npos) << panorama.error().message();
  }
}

TEST(Exr, AHeaderThatClaimsAnImmenseWindowIsRefusedBeforeMemoryIsTaken) {
  Bytes bytes = exr(8, 8, {{"Y", std::vector<float>(64, 0.5f)}});
  const std::string text(bytes.begin(), bytes.end());
  const std::size_t window = text.find("dataWindow") + 11 + 6 + 4;
  for (const std::uint8_t high : {std::uint8_t{0x10}, std::uint8_t{0x7f}}) {
    bytes[window + 8 + 3] = bytes[window + 12 + 3] = high;
    EXPECT_FALSE(decode_panorama(bytes, "test").ok());
  }
  bytes[window + 8 + 3] = bytes[window + 12 + 3] = 0;
  bytes[window + 8 + 1] = bytes[window + 12 + 1] = 0x0f;  // 3847 x 3847 in a few hundred bytes
  EXPECT_NE(decode_panorama(bytes, "test").error().message().find("claims"), std::string::npos);
}

}  // namespace
}  // namespace pliant::test
