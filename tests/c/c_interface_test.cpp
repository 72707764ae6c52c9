// The C interface against the C++ one.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <thread>
#include <vector>

#include "pliant/content.h"
#include "pliant/pliant.h"
#include "tests/c/hold_session.h"

namespace pliant {
namespace {

std::string shipped(const char* name) {
  return std::string(PLIANT_SOURCE_DIR "/content/levels/") + name;
}

std::vector<felt_in_c> press_in_cxx(const std::string& level, double y, int ticks) {
  auto session = Session::open(load_scene(level).value()).value();
  const std::string probe = session.effectors()[0];
  std::vector<felt_in_c> felt;
  for (int i = 0; i < ticks; ++i) {
    EXPECT_TRUE(session.move(probe, {0.002 * std::sin(0.02 * i), y - 2e-5 * i, 0.0}));
    EXPECT_TRUE(session.step());
    const Reading reading = session.reading(probe).value();
    felt.push_back({reading.force.x, reading.force.y, reading.force.z, reading.depth});
  }
  return felt;
}

// Surfaces, and soft bodies.
TEST(CInterface, GivesTheBitsOfTheCxxInterface) {
  for (const char* const name : {"minimal.gltf", "instrument.glb"}) {
    const std::string level = shipped(name);
    Session session = Session::open(load_scene(level).value()).value();
    const double top = session.bounds().value().max.y;
    const std::vector<felt_in_c> expected = press_in_cxx(level, top + 0.001, 300);
    std::vector<felt_in_c> felt(300);
    ASSERT_EQ(press_in_c(level.c_str(), top + 0.001, 300, felt.data()), 0);
    EXPECT_EQ(std::memcmp(felt.data(), expected.data(), 300 * sizeof felt[0]), 0) << name;
    double most = 0.0;
    for (const felt_in_c& each : felt) most = std::max(most, std::abs(each.y));
    EXPECT_GT(most, 0.01) << name << " was not touched";
  }
}

TEST(CInterface, RunsTwoSessionsOnTwoThreads) {
  const std::string level = shipped("minimal.gltf");
  Session session = Session::open(load_scene(level).value()).value();
  const double top = session.bounds().value().max.y;
  std::vector<felt_in_c> felt[2] = {std::vector<felt_in_c>(300), std::vector<felt_in_c>(300)};
  int failed[2] = {1, 1};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 2; ++i)
      threads.emplace_back([&, i] { failed[i] = press_in_c(level.c_str(), top + 0.001, 300, felt[i].data()); });
  }
  EXPECT_EQ(failed[0], 0);
  EXPECT_EQ(failed[1], 0);
  EXPECT_EQ(std::memcmp(felt[0].data(), felt[1].data(), 300 * sizeof felt[0][0]), 0);
}

TEST(CInterface, IsUsedInEveryPartByAProgramInC) {
  constexpr std::uint32_t kSide = 21;
  MeshData sheet;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i)
    sheet.position.push_back({0.005f * float(i % kSide) - 0.05f, 0, 0.005f * float(i / kSide) - 0.05f});
  for (std::uint32_t i = 0; i + kSide < kSide * kSide; ++i)
    if (i % kSide + 1 < kSide)
      for (const std::uint32_t corner : {i, i + kSide, i + 1, i + 1, i + kSide, i + kSide + 1})
        sheet.index.push_back(corner);
  Scene scene("sheet");
  scene.add_surface("tissue", sheet);
  scene.add_probe("finger");
  const std::string file = ::testing::TempDir() + "c_interface.glb";
  ASSERT_TRUE(save_scene(scene, file));
  EXPECT_EQ(use_all_in_c(file.c_str()), 0);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace pliant
