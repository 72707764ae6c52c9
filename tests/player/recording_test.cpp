// Recordings of a run: to the bit, whole, and of older formats.
#include "engine/run/recording.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace pliant {
namespace {

namespace fs = std::filesystem;

std::string recorded_bytes(const RecordingHeader& header, std::size_t ticks) {
  const fs::path file = fs::temp_directory_path() / ("pliant-recording-" + std::to_string(::getpid()));
  auto writer = RecordingWriter::create(file, header);
  EXPECT_TRUE(writer);
  for (std::size_t t = 0; t < ticks; ++t) {
    writer->tick(3 * t);
    for (std::size_t i = 0; i < header.probes.size(); ++i) {
      const double angle = 0.1 * static_cast<double>(t + i);
      writer->pose({{angle, 1.0 / (1.0 + angle), -angle}, {std::cos(angle), std::sin(angle), 0, 0}, t % 3 != 1});
    }
  }
  EXPECT_FALSE(fs::exists(file)) << "it appears only when it is whole";
  EXPECT_TRUE(writer->finish());
  std::ifstream in(file, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  fs::remove(file);
  return bytes;
}

TEST(Recording, ReadsBackToTheBitWhatWasWritten) {
  const RecordingHeader header{"level, one", 2000.0, {"finger", "", "thumb"}};
  const auto read = parse_recording("r", recorded_bytes(header, 50));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->header.level, header.level);
  EXPECT_EQ(read->header.rate, header.rate);
  EXPECT_EQ(read->header.probes, header.probes);
  ASSERT_EQ(read->ticks.size(), 50u);
  ASSERT_EQ(read->poses.size(), 150u);
  EXPECT_EQ(read->ticks[7], 21u);
  const double angle = 0.1 * (7 + 2);
  EXPECT_EQ(read->poses[7 * 3 + 2].position.x, angle);
  EXPECT_EQ(read->poses[7 * 3 + 2].rotation.x, std::sin(angle));
  EXPECT_FALSE(read->poses[7 * 3 + 2].ready);
}

// A recording of one probe and one tick, as an older program wrote it.
std::string old_recording(std::uint32_t version) {
  std::string bytes = "pliantrc";
  Hash hash;
  const auto put = [&](auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    hash.add(value);
  };
  const auto put_text = [&](const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes += text;
    hash.add_bytes(text.data(), text.size());
  };
  put(version);
  put(std::uint32_t{1});
  put(1000.0);
  put_text("level");
  put_text("tip");
  if (version > 1) {
    put(std::uint64_t{77});  // of the scene
    put(std::uint32_t{1});
    put_text("a.deformable.stiffness=3");
  }
  put(std::uint64_t{0});
  for (const double value : {0.1, 0.2, 0.3, 1.0, 0.0, 0.0, 0.0}) put(value);
  put(std::uint8_t{1});
  const std::uint64_t end = hash.value();
  bytes.append(reinterpret_cast<const char*>(&end), sizeof end);
  return bytes;
}

TEST(Recording, OlderFormatsAreReadAndTheirSceneIsNotKnown) {
  for (const std::uint32_t version : {1u, 2u, 3u}) {
    const auto read = parse_recording("r", old_recording(version));
    ASSERT_TRUE(read) << version << ": " << read.error().message();
    EXPECT_EQ(read->header.scene, version == 3 ? 77u : 0u) << version;
    EXPECT_EQ(read->header.settings.size(), version == 1 ? 0u : 1u) << version;
    EXPECT_EQ(read->poses.at(0).position.z, 0.3) << version;
  }
  for (const std::uint32_t version : {0u, 4u, 5u})
    EXPECT_FALSE(parse_recording("r", old_recording(version))) << version;
}

TEST(Recording, OneWithoutATickIsNotWrittenAndReplacesNothing) {
  const fs::path file = fs::temp_directory_path() / ("pliant-no-tick-" + std::to_string(::getpid()));
  fs::remove(file);
  const RecordingHeader header{"level", 1000.0, {"p"}, 0, {}};
  auto good = RecordingWriter::create(file, header);
  ASSERT_TRUE(good);
  good->tick(0);
  good->pose({});
  ASSERT_TRUE(good->finish());
  auto empty = RecordingWriter::create(file, header, true);
  ASSERT_TRUE(empty);
  const fs::path aside = empty->aside();
  const Status finished = empty->finish();
  ASSERT_FALSE(finished);
  EXPECT_NE(finished.error().message().find("no tick"), std::string::npos) << finished.error().message();
  EXPECT_FALSE(fs::exists(aside));
  const auto read = read_recording(file);
  ASSERT_TRUE(read) << "it was replaced";
  EXPECT_EQ(read->ticks.size(), 1u);
  fs::remove(file);
}

TEST(Recording, EveryCutAndEveryFlippedBitIsNoticed) {
  const std::string bytes = recorded_bytes({"level", 1000.0, {"p"}}, 4);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(parse_recording("r", bytes.substr(0, size))) << "cut to " << size;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      const auto read = parse_recording("r", damaged);
      // A pose's last byte is a flag: the hash also covers higher bits that leave it false.
      EXPECT_FALSE(read) << "bit " << bit << " of byte " << i;
    }
  }
}

}  // namespace
}  // namespace pliant
